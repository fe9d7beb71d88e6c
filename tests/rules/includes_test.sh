#!/bin/sh
# includes_test.sh WORK: each broken include of a made-up tree must be found, and nothing else.
set -eu
rules=$(cd "$(dirname "$0")" && pwd)
rm -rf "$1"
mkdir -p "$1"
cd "$1"

write() { mkdir -p "$(dirname "$1")"; printf '%s\n' "$2" >"$1"; }
expect() { # EXIT-CODE TEXT...: what includes.sh says of the tree
    code=0
    sh "$rules/includes.sh" . >../includes_test.out 2>&1 || code=$?
    wanted=$1
    shift
    for text in "$@"; do
        grep -qF -- "$text" ../includes_test.out && continue
        echo "expected: $text"; cat ../includes_test.out; exit 1
    done
    [ "$code" -eq "$wanted" ] || { echo "exit code $code, expected $wanted"; cat ../includes_test.out; exit 1; }
}
# A file that breaks one rule on its second line, alone, then none again.
breaks() { # FILE INCLUDE TEXT
    write "$1" "#include <vector>
#include $2"
    expect 1 "$1:2: " "$3" ", 1 broken rules"
    rm "$1"
}

write iga/core/types.h '#include <Eigen/Core>'
write iga/spline/patch.h '#include "iga/core/types.h"'
write iga/linalg/cholmod_solver.cpp '#include <cholmod.h>'
write iga/mechanics/material.h '#include "iga/spline/patch.h"'
write meshing/surface/surface_mesh.h '#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>'
write meshing/pipeline.h '#include "meshing/surface/surface_mesh.h"'
write rom/pod.h '#include "iga/core/types.h"'
write io/vtk_writer.cpp '#include <vtkNew.h>'
write io/deck.h '#include "rom/pod.h"'
write drivers/commands/solve.cpp '#include "io/deck.h"'
write tests/io/vtk_writer_test.cpp '#include <vtkNew.h>'
expect 0 ", 0 broken rules"

breaks iga/core/a.h '"iga/spline/patch.h"' 'iga/core must not include iga/spline'
breaks iga/linalg/a.cpp '"iga/mechanics/material.h"' 'iga/linalg must not include iga/mechanics'
breaks iga/spline/a.cpp '"io/deck.h"' 'iga/spline must not include io'
breaks meshing/surface/a.h '"rom/pod.h"' 'meshing/surface must not include rom'
breaks rom/a.h '"meshing/pipeline.h"' 'rom must not include meshing/pipeline'
breaks rom/a.cpp '"io/deck.h"' 'rom must not include io'
breaks verification/a.cpp '"tests/io/vtk_writer_test.cpp"' 'verification must not include tests'
breaks iga/spline/a.cpp '"patch.h"' '"patch.h" is no file'
breaks iga/other/a.h '"iga/core/types.h"' 'is in no folder'
breaks iga/spline/a.h '<Eigen/Core>' 'iga/core/types\.h only'
breaks iga/spline/a.h '<Eigen/LU>' '.*\.cpp only'
breaks iga/solve/a.cpp '<cholmod.h>' '<cholmod.h> belongs into'
breaks iga/solve/a.cpp '<petscksp.h>' '<petscksp.h> belongs into'
breaks rom/a.cpp '<hdf5.h>' '<hdf5.h> belongs into'
breaks drivers/a.cpp '<vtkNew.h>' '<vtkNew.h> belongs into'
breaks drivers/a.cpp '<toml.hpp>' '<toml.hpp> belongs into'
breaks meshing/surface/a.cpp '<CGAL/Surface_mesh.h>' '<CGAL/Surface_mesh.h> belongs into'
breaks meshing/layout/a.h '<OpenMesh/Core/IO/MeshIO.hh>' 'surface_mesh\.h only'
breaks iga/core/a.cpp '<boost/graph/graph.hpp>' 'in no line of'
expect 0 ", 0 broken rules"
