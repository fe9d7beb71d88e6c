#include "io/family_members.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <set>

#include "iga/core/error.h"
#include "io/atomic_file.h"
#include "io/did_you_mean.h"
#include "meshing/parts/part_surface.h"

namespace couture::io {

namespace {

constexpr const char* default_reference = "reference";

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        std::string cell = line.substr(begin, end - begin);
        const auto is_blank = [](unsigned char c) { return std::isspace(c) != 0; };
        cell.erase(cell.begin(), std::find_if_not(cell.begin(), cell.end(), is_blank));
        cell.erase(std::find_if_not(cell.rbegin(), cell.rend(), is_blank).base(), cell.end());
        cells.push_back(std::move(cell));
        begin = end + 1;
    }
    return cells;
}

void check_name(const std::string& name, const std::string& where) {
    const bool is_right = !name.empty() && name[0] != '.' &&
                          std::all_of(name.begin(), name.end(), [](unsigned char c) {
                              return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
                          });
    if (is_right) return;
    throw InputError(
        "{}: '{}' is no name of a member; it becomes that of files: letters, digits, '_', '-', '.'",
        where, name);
}

class Table {
  public:
    explicit Table(const std::filesystem::path& path) : path_(path) {
        const std::string text = read_text(path);
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
        int number = 0;
        for (std::size_t begin = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
             begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            const std::vector<std::string> cells = cells_of(text.substr(begin, end - begin));
            begin = end + 1;
            ++number;
            if (cells.size() == 1 && cells[0].empty()) continue;
            if (head_.empty()) {
                read_head(cells, number);
            } else {
                read_member(cells, number);
            }
        }
        if (members_.empty()) {
            throw InputError(
                "{}: no members; write a line with names of parameters and one for each member",
                path.filename().string());
        }
    }
    [[nodiscard]] std::vector<FamilyMember> members() && { return std::move(members_); }

  private:
    [[nodiscard]] std::string where(int line) const {
        return fmt::format("{}:{}", path_.filename().string(), line);
    }

    void read_head(const std::vector<std::string>& cells, int line) {
        std::set<std::string> known;
        if (cells.size() == 1 && cells[0].find(';') != std::string::npos) {
            throw InputError("{}: cells are parted by ';'; part them by commas", where(line));
        }
        for (const std::string& cell : cells) {
            if (cell.empty() || !known.insert(cell).second) {
                throw InputError("{}: column '{}' {}", where(line), cell,
                                 cell.empty() ? "has no name" : "is there twice");
            }
        }
        head_ = cells;
    }

    void read_member(const std::vector<std::string>& cells, int line) {
        if (cells.size() != head_.size()) {
            throw InputError("{}: {} cells, but {} columns: {}", where(line), cells.size(),
                             head_.size(), quoted_list(head_));
        }
        FamilyMember member;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            if (head_[k] == "name") {
                member.name = cells[k];
            } else if (head_[k] == "surface") {
                member.surface = read_path(cells[k], line);
            } else if (head_[k] == "volume") {
                member.volume = read_path(cells[k], line);
            } else {
                member.parameters[head_[k]] = read_number(cells[k], head_[k], line);
            }
        }
        if (std::find(head_.begin(), head_.end(), "name") == head_.end()) {
            const auto& file = member.surface.empty() ? member.volume : member.surface;
            member.name =
                file.empty() ? fmt::format("member_{}", members_.size() + 1) : file.stem().string();
        }
        check_name(member.name, where(line));
        if (!names_.insert(member.name).second) {
            throw InputError("{}: there is a member '{}' already", where(line), member.name);
        }
        members_.push_back(std::move(member));
    }

    [[nodiscard]] std::filesystem::path read_path(const std::string& cell, int line) const {
        std::filesystem::path path = path_.parent_path() / cell;
        if (!std::filesystem::is_regular_file(path)) {
            throw InputError("{}: there is no file {} (paths are relative to the table)",
                             where(line), path.string());
        }
        return path;
    }

    [[nodiscard]] double read_number(const std::string& cell, const std::string& column,
                                     int line) const {
        double value = 0.0;
        const char* end = cell.data() + cell.size();
        const auto [stop, error] = std::from_chars(cell.data(), end, value);
        if (error != std::errc() || stop != end || !std::isfinite(value)) {
            throw InputError("{}: '{}' in column '{}' is no number", where(line), cell, column);
        }
        return value;
    }

    std::filesystem::path path_;
    std::vector<std::string> head_;
    std::set<std::string> names_;
    std::vector<FamilyMember> members_;
};

// @throws InputError  that the key names no member
[[noreturn]] void throw_unknown(const MeshDeck& deck, const std::string& key,
                                const std::string& name, const std::vector<FamilyMember>& members) {
    std::vector<std::string> names;
    for (const FamilyMember& member : members) names.push_back(member.name);
    const std::string help = did_you_mean(name, names);
    throw InputError("{}: [family] {} '{}' is none of the members{} There are {}",
                     deck.path.filename().string(), key, name, help.empty() ? "." : help,
                     quoted_list(names));
}

// The reference to the front.
void order_members(const MeshDeck& deck, std::vector<FamilyMember>& members) {
    const std::string& name = deck.family->reference;
    if (name.empty()) {
        const bool is_there = std::any_of(members.begin(), members.end(), [](const auto& member) {
            return member.name == default_reference;
        });
        if (!is_there) {
            members.insert(members.begin(), {default_reference, deck.parameters, deck.surface, {}});
            return;
        }
    }
    const std::string wanted = name.empty() ? default_reference : name;
    const auto reference =
        std::find_if(members.begin(), members.end(),
                     [&](const FamilyMember& member) { return member.name == wanted; });
    if (reference == members.end()) throw_unknown(deck, "reference", wanted, members);
    std::rotate(members.begin(), reference, reference + 1);
}

std::vector<FamilyMember> star_design(const MeshDeck& deck) {
    const auto& parts = meshing::part_surfaces();
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const auto& info) { return info.name == deck.part; });
    if (part == parts.end()) {
        throw InputError(
            "{}: [family] design = \"star\" varies the parameters of a part; '{}' is none. List "
            "members in a file: parameters = \"members.csv\"",
            deck.path.filename().string(), deck.part.empty() ? deck.surface.string() : deck.part);
    }
    constexpr double metres_per_millimetre = 1e-3;
    const double millimetre = metres_per_millimetre / deck.units.scale(dimensions::length);
    std::vector<FamilyMember> members{{default_reference, deck.parameters, {}, {}}};
    const auto add = [&](const std::string& name, const char* end, double value) {
        FamilyMember member{name + end, deck.parameters, {}, {}};
        member.parameters[name] = value;
        members.push_back(std::move(member));
    };
    for (const meshing::PartParameter& parameter : part->parameters) {
        const auto own = deck.parameters.find(parameter.name);
        const double middle =
            own != deck.parameters.end() ? own->second : millimetre * parameter.value;
        const double low = millimetre * parameter.min;
        const double high = millimetre * parameter.max;
        add(parameter.name, "_low", low);
        if (deck.family->level == 2) {
            add(parameter.name, "_low_half", 0.5 * (low + middle));
            add(parameter.name, "_high_half", 0.5 * (high + middle));
        }
        add(parameter.name, "_high", high);
    }
    return members;
}

std::vector<FamilyMember> listed_members(const MeshDeck& deck) {
    std::vector<FamilyMember> members = read_member_table(deck.family->parameters);
    for (FamilyMember& member : members) {
        if (!member.volume.empty()) {
            throw InputError(
                "{}: member '{}' is a 'volume'; a family is meshed from a 'surface' or a part",
                deck.family->parameters.filename().string(), member.name);
        }
        if (deck.part.empty() != !member.surface.empty()) {
            throw InputError(
                "{}: member '{}' {}", deck.family->parameters.filename().string(), member.name,
                deck.part.empty() ? "needs a 'surface', as the deck's geometry is a file"
                                  : "is a 'surface', but the deck's geometry is a part");
        }
        if (deck.part.empty() && !member.parameters.empty()) {
            throw InputError("{}: member '{}' is a file, which has no parameter '{}'",
                             deck.family->parameters.filename().string(), member.name,
                             member.parameters.begin()->first);
        }
        member.parameters.insert(deck.parameters.begin(), deck.parameters.end());
    }
    order_members(deck, members);
    return members;
}

// The reference and those that the deck names.
std::vector<FamilyMember> chosen(const MeshDeck& deck, const std::vector<FamilyMember>& members) {
    const std::vector<std::string>& names = deck.family->members;
    for (const std::string& name : names) {
        if (std::ranges::none_of(members, [&](const auto& one) { return one.name == name; })) {
            throw_unknown(deck, "members", name, members);
        }
    }
    std::vector<FamilyMember> some{members.front()};
    std::copy_if(members.begin() + 1, members.end(), std::back_inserter(some),
                 [&](const FamilyMember& member) {
                     return std::ranges::find(names, member.name) != names.end();
                 });
    return some;
}

}  // namespace

std::vector<FamilyMember> read_member_table(const std::filesystem::path& path) {
    return Table(path).members();
}

std::vector<FamilyMember> family_members(const MeshDeck& deck) {
    std::vector<FamilyMember> members =
        deck.family->parameters.empty() ? star_design(deck) : listed_members(deck);
    return deck.family->members.empty() ? members : chosen(deck, members);
}

}  // namespace couture::io
