// Writes the dimensioned drawings of all parts that meshing/parts/README.md shows.

#include <fmt/format.h>

#include <exception>
#include <filesystem>

#include "drivers/part_picture.h"
#include "meshing/parts/part_surface.h"

int main(int n_arguments, char** arguments) {
    if (n_arguments != 2) {
        fmt::print(stderr, "usage: couture_part_pictures FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = arguments[1];
        std::filesystem::create_directories(folder);
        for (const couture::meshing::PartInfo& part : couture::meshing::part_surfaces()) {
            couture::drivers::write_part_picture(folder / (part.name + ".png"), part.name);
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
