#include "drivers/result_picture.h"

#include <algorithm>

#include "drivers/summary.h"
#include "iga/core/error.h"
#include "iga/post/stress.h"
#include "io/quantity.h"
#include "io/scene.h"

namespace couture::drivers {

namespace {

/// The largest displacement is drawn at least this large, relative to the part.
constexpr double drawn_displacement = 0.1;

int voigt_index(const std::string& quantity) {
    static const std::vector<std::string> names = {"xx", "yy", "zz", "yz", "xz", "xy"};
    const std::string component = quantity.substr(quantity.size() - 2);
    return static_cast<int>(std::find(names.begin(), names.end(), component) - names.begin());
}

/// Coefficients of a quantity from those of displacement and stress.
VectorX coefficients_of(const std::string& quantity, const MatrixX& displacement,
                        const MatrixX& stress) {
    if (quantity == "potential") {
        return displacement.col(0);
    }
    if (quantity == "displacement_magnitude") {
        return displacement.rowwise().norm();
    }
    if (quantity.starts_with("displacement_")) {
        const int axis = quantity.back() - 'x';
        return axis < displacement.cols() ? VectorX(displacement.col(axis))
                                          : VectorX::Zero(displacement.rows());
    }
    if (quantity.starts_with("stress_")) {
        return stress.col(voigt_index(quantity));
    }
    if (quantity.starts_with("flux_")) {
        return stress.col(quantity.back() - 'x');
    }
    VectorX values(stress.rows());
    for (Eigen::Index i = 0; i < stress.rows(); ++i) {
        const Vector<6> state = stress.row(i).transpose();
        values[i] = quantity == "von_mises" ? iga::von_mises(state)
                                            : iga::principal_stresses(state)[quantity.back() - '1'];
    }
    return values;
}

/// "von_mises [MPa]"
std::string legend_of(const std::string& quantity, bool is_elasticity,
                      const io::UnitSystem& units) {
    const auto [length, force, pressure] = units.unit_names();
    const io::Dimension dimension = io::find_quantity(quantity, is_elasticity)->dimension;
    if (dimension == io::dimensions::pressure) {
        return quantity + " [" + pressure + "]";
    }
    return dimension == io::dimensions::length ? quantity + " [" + length + "]" : quantity;
}

}  // namespace

template <int d>
void write_picture(const std::filesystem::path& path, const io::Deck& deck,
                   const iga::SpacePtr<d>& space, const iga::CaseResult<d>& result,
                   const MatrixX& stress) {
    const bool is_elasticity = deck.problem.physics == iga::Physics::elasticity;
    const MatrixX& displacement = result.displacement.coefficients;
    io::SceneOptions options;
    options.title = deck.title + (result.name.empty() ? "" : ": " + result.name);
    if (is_elasticity) {
        const double largest = displacement.rowwise().norm().maxCoeff();
        const double wanted = drawn_displacement * space->geometry().size();
        options.displacement = displacement;
        options.displacement_scale =
            deck.output.png_scale.value_or(largest > 0.0 ? std::max(1.0, wanted / largest) : 1.0);
        options.title += fmt::format(" (displacement x {:.3g})", options.displacement_scale);
    }
    options.values = coefficients_of(deck.output.png_quantity, displacement, stress);
    options.legend = legend_of(deck.output.png_quantity, is_elasticity, deck.units);
    io::render_png(path, io::make_scene<d>(*space, options));
}

template void write_picture<2>(const std::filesystem::path&, const io::Deck&,
                               const iga::SpacePtr<2>&, const iga::CaseResult<2>&, const MatrixX&);
template void write_picture<3>(const std::filesystem::path&, const io::Deck&,
                               const iga::SpacePtr<3>&, const iga::CaseResult<3>&, const MatrixX&);

}  // namespace couture::drivers
