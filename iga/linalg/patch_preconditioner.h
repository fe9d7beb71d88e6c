#pragma once

#include "iga/linalg/block_matrix.h"
#include "iga/linalg/box_solver.h"
#include "iga/linalg/patch_structure.h"

namespace couture::iga {

/// Symmetric positive definite approximation of A^-1 on interiors and interfaces of patches. Each
/// component's diagonal blocks of A are taken for S K S: K the sum over the patches of operators
/// with constant coefficients on the unit box, S the diagonal that makes diag(S K S) = diag(A).
/// K is eliminated patch by patch, exactly; of the Schur complement on an interface only what
/// couples the functions of that interface is kept, in the product of its tangential eigenvectors,
/// where it is diagonal. Functions on the wire basket (where interfaces meet) are left out: the
/// result is zero there.
class PatchPreconditioner {
  public:
    /// @param is_fixed  n_unknowns flags
    PatchPreconditioner(const BlockMatrix& matrix, const std::vector<char>& is_fixed,
                        const PatchStructure& structure);
    /// @param coefficients  of each patch one per component
    /// @param diagonal  of A
    PatchPreconditioner(const std::vector<std::vector<PatchCoefficients>>& coefficients,
                        const VectorX& diagonal, const std::vector<char>& is_fixed,
                        const PatchStructure& structure);

    /// A^-1 r, about.
    [[nodiscard]] VectorX apply(const VectorX& r) const;
    /// Bytes held.
    [[nodiscard]] std::size_t memory() const;

  private:
    /// One component of a patch.
    struct Interior {
        int patch = 0;
        int component = 0;
        PatchCoefficients coefficients;
        BoxSolver solver;
        /// Unknown of each function of the box; -1 if it is fixed or not in the interior.
        std::vector<int> unknowns;
        /// Faces that this patch has a side in: (face, which of its two sides).
        std::vector<std::pair<int, int>> faces;
    };
    /// One component of an interface.
    struct Face {
        /// Interiors on both sides, and their sides.
        std::array<int, 2> interiors{};
        std::array<int, 2> sides{};
        /// Unknown of each function of the side, in the order of the respective patch; -1 if it is
        /// fixed or on the wire basket.
        std::array<std::vector<int>, 2> unknowns;
        /// Tangential eigenvectors in the order of the first side.
        std::array<std::shared_ptr<const Eigenbasis>, 2> bases;
        /// 1 / eigenvalue of the Schur complement.
        MatrixX inverses;
    };

    void make_interiors(const std::vector<std::vector<PatchCoefficients>>& coefficients,
                        const std::vector<char>& is_fixed);
    void make_faces(const std::vector<char>& is_fixed, int nc);
    void make_scaling(const VectorX& diagonal_of_A, int nc);
    [[nodiscard]] std::shared_ptr<const Eigenbasis> eigenbasis(
        const std::shared_ptr<const Univariate>& functions, bool without_first, bool without_last);
    /// Eigenvalues of the Schur complement of one side's patch: elimination of the interior in the
    /// normal direction, `tangential` the eigenvalues of the other directions.
    [[nodiscard]] VectorX schur_values(const Interior& interior, int side,
                                       const VectorX& tangential) const;
    /// Coupling K times the interior's values at the side's functions.
    [[nodiscard]] VectorX couple_to_side(const Interior& interior, int side,
                                         const VectorX& values) const;
    /// The transpose: subtracts from `values` K times the side's functions.
    void subtract_from_interior(const Interior& interior, int side, const VectorX& of_side,
                                VectorX& values) const;

    PatchStructure structure_;
    std::vector<Interior> interiors_;
    std::vector<Face> faces_;
    /// S.
    VectorX scaling_;
    struct KnownBasis {
        std::shared_ptr<const Univariate> functions;
        bool without_first;
        bool without_last;
        std::shared_ptr<const Eigenbasis> basis;
    };
    std::vector<KnownBasis> known_bases_;
};

}  // namespace couture::iga
