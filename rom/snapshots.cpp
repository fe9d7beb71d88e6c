#include "rom/snapshots.h"

#include <cmath>

#include "iga/core/error.h"
#include "iga/topology/space.h"

namespace couture::rom {

namespace {

void check_parameters(const SnapshotSet& set) {
    const int n = set.parameters.size();
    if (static_cast<int>(set.factor_power.size()) != n || set.reference_point.size() != n) {
        throw InputError(
            "SnapshotSet: {} powers and {} reference values for {} parameters; each takes one",
            set.factor_power.size(), set.reference_point.size(), n);
    }
    for (int i = 0; i < n; ++i) {
        const Parameter& parameter = set.parameters.parameters()[i];
        const int power = set.factor_power[i];
        if (power < -1 || power > 1) {
            throw InputError(
                "SnapshotSet: power {} of parameter '{}'; it must be 0, 1 (loads) or -1 (moduli)",
                power, parameter.name);
        }
        if (!std::isfinite(set.reference_point[i])) {
            throw InputError("SnapshotSet: the reference value of '{}' is not finite",
                             parameter.name);
        }
        if (power == 0) {
            continue;
        }
        if (parameter.group == ParameterGroup::geometry) {
            throw InputError(
                "SnapshotSet: geometry parameter '{}' has the power {}; displacements are not "
                "proportional to it, only loads and moduli may be factored",
                parameter.name, power);
        }
        if (set.reference_point[i] == 0.0 || (power < 0 && !(parameter.lower > 0.0))) {
            throw InputError(
                "SnapshotSet: factored parameter '{}' is {} at the reference, its range starts at "
                "{}; the first must not be 0, a modulus must be positive",
                parameter.name, set.reference_point[i], parameter.lower);
        }
    }
}

void check_points(const MatrixX& points, const std::string& what, std::size_t n_parameters) {
    if (points.rows() < 1 || points.cols() != static_cast<Eigen::Index>(n_parameters)) {
        throw InputError(
            "SnapshotSet: {} points with {} coordinates for {}; expected at least one with {}, one "
            "for each parameter that is not factored",
            points.rows(), points.cols(), what, n_parameters);
    }
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
        for (Eigen::Index k = 0; k < points.cols(); ++k) {
            if (!(points(i, k) >= 0.0 && points(i, k) <= 1.0)) {
                throw InputError(
                    "SnapshotSet: coordinate {} of point {} for {} is {}; designs live in the unit "
                    "cube",
                    k, i, what, points(i, k));
            }
        }
    }
}

void check_designs(const SnapshotSet& set) {
    const auto n_sampled = [&](ParameterGroup group) {
        return sampled_parameters(set.parameters, set.factor_power, group).size();
    };
    check_points(set.geometry_points, "geometries", n_sampled(ParameterGroup::geometry));
    std::size_t i = 0;
    for (const auto& [group, what] : {std::pair{ParameterGroup::load, "loads"},
                                      std::pair{ParameterGroup::material, "materials"}}) {
        if (n_sampled(group) == 0) {
            continue;
        }
        if (i >= set.mechanics_factors.size()) {
            throw InputError("SnapshotSet: there is no design for {}; expected one", what);
        }
        check_points(set.mechanics_factors[i], what, n_sampled(group));
        ++i;
    }
    if (i != set.mechanics_factors.size()) {
        throw InputError(
            "SnapshotSet: {} designs of loads and materials; expected {}, one for each group with "
            "parameters that are not factored",
            set.mechanics_factors.size(), i);
    }
}

bool is_refused(const MatrixX& fields, Eigen::Index column) {
    return std::isnan(fields(0, column));
}

void check_fields(const MatrixX& fields, const char* what, Eigen::Index n_rows,
                  Eigen::Index n_columns) {
    if (fields.rows() != n_rows || fields.cols() != n_columns) {
        throw InputError("SnapshotSet: {} are {} x {}; expected {} x {}", what, fields.rows(),
                         fields.cols(), n_rows, n_columns);
    }
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
        if (is_refused(fields, j) ? !fields.col(j).array().isNaN().all()
                                  : !fields.col(j).allFinite()) {
            throw InputError(
                "SnapshotSet: column {} of the {} has values that are not finite; a refused one "
                "is NaN throughout",
                j, what);
        }
    }
    if (accepted_columns(fields).empty()) {
        throw InputError(
            "SnapshotSet: all {} columns of the {} were refused; nothing to learn from",
            fields.cols(), what);
    }
}

}  // namespace

TensorDesign SnapshotSet::design() const {
    TensorDesign design;
    if (geometry_points.cols() > 0) {
        design.factors.push_back(geometry_points);
    }
    design.factors.insert(design.factors.end(), mechanics_factors.begin(), mechanics_factors.end());
    return design;
}

std::vector<int> sampled_parameters(const ParameterSpace& parameters,
                                    const std::vector<int>& factor_power, ParameterGroup group) {
    std::vector<int> sampled;
    for (const int i : parameters.group(group)) {
        if (factor_power.at(i) == 0) {
            sampled.push_back(i);
        }
    }
    return sampled;
}

std::vector<int> accepted_columns(const MatrixX& fields) {
    std::vector<int> accepted;
    for (int j = 0; j < fields.cols(); ++j) {
        if (!fields.col(j).array().isNaN().any()) {
            accepted.push_back(j);
        }
    }
    return accepted;
}

void check(const SnapshotSet& set) {
    check_parameters(set);
    check_designs(set);
    const Eigen::Index n_rows = 3 * iga::Space<3>(set.reference).n_dofs();
    const int n_geometries = set.n_geometries();
    const int n_mechanics = set.n_mechanics();
    if (set.geometry_points.cols() == 0 && n_geometries != 1) {
        throw InputError(
            "SnapshotSet: {} geometries without a geometry parameter; there must be one",
            n_geometries);
    }
    check_fields(set.control_points, "control points", n_rows, n_geometries);
    check_fields(set.displacements, "displacements", n_rows,
                 static_cast<Eigen::Index>(n_geometries) * n_mechanics);
    for (int g = 0; g < n_geometries; ++g) {
        for (int m = 0; is_refused(set.control_points, g) && m < n_mechanics; ++m) {
            if (!is_refused(set.displacements, g * n_mechanics + m)) {
                throw InputError(
                    "SnapshotSet: displacement {} was solved on geometry {}, which was refused; "
                    "refuse it too",
                    g * n_mechanics + m, g);
            }
        }
    }
}

}  // namespace couture::rom
