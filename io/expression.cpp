#include "io/expression.h"

#include <muParser.h>

#include <atomic>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_map>

#include "iga/core/error.h"
#include "io/did_you_mean.h"

namespace couture::io {

struct Expression::Source {
    std::string text;
    std::uint64_t id = 0;
};

namespace {

/// A parser keeps the addresses of its variables and writes to itself while it evaluates: one for
/// each thread.
struct Evaluator {
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    double t = 0.0;
    mu::Parser parser;

    explicit Evaluator(const std::string& text) {
        parser.DefineVar("x", &x);
        parser.DefineVar("y", &y);
        parser.DefineVar("z", &z);
        parser.DefineVar("t", &t);
        parser.DefineConst("pi", std::numbers::pi);
        parser.DefineConst("e", std::numbers::e);
        parser.ClearPostfixOprt();
        parser.SetExpr(text);
    }
    Evaluator(const Evaluator&) = delete;
    Evaluator& operator=(const Evaluator&) = delete;
};

const std::vector<std::string>& known_names() {
    static const std::vector<std::string> names = {
        "x",    "y",    "z",    "t",    "pi",   "e",     "sin", "cos", "tan",   "asin",
        "acos", "atan", "sinh", "cosh", "tanh", "atan2", "exp", "log", "log10", "log2",
        "sqrt", "abs",  "min",  "max",  "sign", "rint",  "sum", "avg"};
    return names;
}

[[noreturn]] void refuse(const std::string& text, const mu::Parser::exception_type& error) {
    const bool has_place =
        error.GetPos() >= 0 && static_cast<std::size_t>(error.GetPos()) < text.size();
    const auto place = has_place ? static_cast<std::size_t>(error.GetPos()) : text.size();
    std::string reason;
    if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
        reason = fmt::format("'{}' is neither a function nor one of x, y, z, t, pi, e{}",
                             error.GetToken(), did_you_mean(error.GetToken(), known_names()));
    } else {
        reason = has_place ? "can't be read here" : "ends too early";
        if (error.GetCode() == mu::ecMISSING_PARENS) {
            reason = "a closing parenthesis is missing";
        }
    }
    throw InputError("expression: {}\n        {}\n        {}^", reason, text,
                     std::string(place, ' '));
}

/// Place of an '=' that is not part of a comparison, or npos.
std::size_t find_assignment(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') {
            continue;
        }
        if (i + 1 < text.size() && text[i + 1] == '=') {
            ++i;
        } else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) {
            return i;
        }
    }
    return std::string::npos;
}

/// Longer texts are no formulas, and would overflow the parser's recursion.
constexpr std::size_t max_length = 10'000;
constexpr int max_depth = 100;

/// Refuses what the parser takes without a word but nobody means: a comma outside of a function's
/// parentheses, whose left side would be dropped ("1,5" is not 1.5).
void check_structure(const std::string& text) {
    if (text.size() > max_length) {
        throw InputError("expression: it has {} characters; at most {} are read", text.size(),
                         max_length);
    }
    std::vector<bool> is_call;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '(') {
            const std::size_t before =
                i == 0 ? std::string::npos : text.find_last_not_of(' ', i - 1);
            is_call.push_back(before != std::string::npos &&
                              (std::isalnum(static_cast<unsigned char>(text[before])) != 0 ||
                               text[before] == '_'));
            if (is_call.size() > max_depth) {
                throw InputError("expression: more than {} parentheses inside each other",
                                 max_depth);
            }
        } else if (text[i] == ')' && !is_call.empty()) {
            is_call.pop_back();
        } else if (text[i] == ',' && (is_call.empty() || !is_call.back())) {
            throw InputError(
                "expression: a comma stands between the arguments of a function only; decimals are "
                "written with a point, as 1.5\n        {}\n        {}^",
                text, std::string(i, ' '));
        }
    }
}

std::atomic<std::uint64_t> n_expressions = 0;

}  // namespace

Expression::Expression(const std::string& text) {
    if (text.find_first_not_of(' ') == std::string::npos) {
        throw InputError("expression: the text is empty; give a number or an expression");
    }
    check_structure(text);
    if (const std::size_t place = find_assignment(text); place != std::string::npos) {
        throw InputError("expression: '=' assigns; compare with '=='\n        {}\n        {}^",
                         text, std::string(place, ' '));
    }
    source_ = std::make_shared<const Source>(Source{text, n_expressions++});
    try {
        Evaluator evaluator(text);
        // First: GetUsedVar takes an unknown name for a variable.
        static_cast<void>(evaluator.parser.Eval());
        for (const auto& [name, address] : evaluator.parser.GetUsedVar()) {
            variables_.push_back(name);
        }
    } catch (const mu::Parser::exception_type& error) {
        refuse(text, error);
    }
}

const std::string& Expression::text() const { return source_->text; }

double Expression::operator()(const Vector3& x, double t) const {
    thread_local std::unordered_map<std::uint64_t, std::unique_ptr<Evaluator>> evaluators;
    std::unique_ptr<Evaluator>& evaluator = evaluators[source_->id];
    if (!evaluator) {
        evaluator = std::make_unique<Evaluator>(source_->text);
    }
    evaluator->x = x[0];
    evaluator->y = x[1];
    evaluator->z = x[2];
    evaluator->t = t;
    const double value = evaluator->parser.Eval();
    if (!std::isfinite(value)) {
        throw InputError("expression '{}': is {} at x = {:.6g}, y = {:.6g}, z = {:.6g}, t = {:.6g}",
                         source_->text, value, x[0], x[1], x[2], t);
    }
    return value;
}

}  // namespace couture::io
