#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace couture::meshing {

/// One boundary operator: column j lists the cells of one dimension less that bound cell j, each
/// with +1 or -1, rows ascending.
struct BoundaryOperator {
    struct Entry {
        int row;
        int value;
    };
    int n_rows = 0;
    std::vector<std::vector<Entry>> columns;
};

/// Vertices, edges, faces and volumes with what bounds what: combinatorics only. Cells of
/// dimension k are numbered from 0; vertices keep the numbers that they were given, gaps closed.
class CellComplex {
  public:
    /// Cells by their boundary operators.
    ///
    /// @param boundaries  operator k - 1 takes cells of dimension k to cells of dimension k - 1;
    ///                    at least one
    /// @throws TopologyError  if the sizes don't fit, or if the boundary of a boundary is not zero;
    ///                        names the cell
    explicit CellComplex(std::vector<BoundaryOperator> boundaries);

    /// Of the largest cells.
    [[nodiscard]] int dimension() const { return static_cast<int>(boundaries_.size()); }
    /// k_i of [Maquart19] Table 6.2.
    ///
    /// @param dimension  in 0 .. dimension()
    [[nodiscard]] int n_cells(int dimension) const;
    /// Cells of `dimension` to those of one less.
    ///
    /// @param dimension  in 1 .. dimension()
    [[nodiscard]] const BoundaryOperator& boundary(int dimension) const {
        return boundaries_.at(dimension - 1);
    }

    /// Alternating sum of the numbers of cells.
    ///
    /// Source: [Maquart19] Eq. (6.5)
    [[nodiscard]] int euler_characteristic() const;

  private:
    std::vector<BoundaryOperator> boundaries_;
};

/// Complexes of cells by vertex numbers (any, not negative); vertices, edges and faces that cells
/// share are there once.
///
/// @throws InputError  for a negative number or one that stands twice in a cell
/// @throws TopologyError  if there are no cells, or if two hexahedra share the vertices of a face
///                        in different cyclic orders; names the cell
[[nodiscard]] CellComplex make_triangle_complex(std::span<const std::array<int, 3>> triangles);
/// Corners of a quad in cyclic order.
[[nodiscard]] CellComplex make_quad_complex(std::span<const std::array<int, 4>> quads);
[[nodiscard]] CellComplex make_tetrahedron_complex(std::span<const std::array<int, 4>> tetrahedra);
/// Corner i of a hexahedron lies at (i & 1, i >> 1 & 1, i >> 2 & 1) of the unit cube.
[[nodiscard]] CellComplex make_hexahedron_complex(std::span<const std::array<int, 8>> hexahedra);

/// The complex of all cells of one dimension less that bound exactly one of the largest cells, and
/// of what bounds them.
///
/// @throws TopologyError  if there are none: the complex is closed
[[nodiscard]] CellComplex boundary_complex(const CellComplex& complex);

/// Betti numbers b_0 .. b_d over the rational numbers: b_k = n_k - rank d_k - rank d_{k+1}. Ranks
/// are computed modulo the primes 2^31 - 1 and 2^31 - 19; both can only be too small, and are
/// unless torsion of that order occurs.
///
/// @throws TopologyError  if the two primes disagree
///
/// Source: [Maquart19] Eq. (6.5)-(6.7), Table 6.1
[[nodiscard]] std::vector<int> betti_numbers(const CellComplex& complex);

/// The same over the integers modulo a prime; modulo 2 they tell a projective plane from a disc.
///
/// @param prime  in [2, 2^31)
/// @throws InputError  if it is not prime
[[nodiscard]] std::vector<int> betti_numbers(const CellComplex& complex, std::int64_t prime);

/// A compact 3-manifold with boundary has 2 chi(V) = chi(boundary).
///
/// @throws TopologyError  with the two values; then the volumes touch somewhere along an edge or at
///                        a vertex only
///
/// Source: [Maquart19] Eq. (6.13), left part. Differs: chi(V) = 1 - g holds for a connected
/// boundary only; in general it is the sum of 1 - g over the boundary's components.
void check_volume_boundary(const CellComplex& volume);

}  // namespace couture::meshing
