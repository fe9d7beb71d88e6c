# Headers that nearly every source reads: they are half of the time that a source takes. A source
# still names what it uses: the tidy preset compiles without (CMAKE_DISABLE_PRECOMPILE_HEADERS).
function(couture_precompile target) # [HEADER...]: more of them
    target_precompile_headers(${target} PRIVATE
        <Eigen/Core> <Eigen/SparseCore> <fmt/format.h>
        <algorithm> <cmath> <filesystem> <functional> <map> <optional> <string> <vector> ${ARGN})
    # With -fpch-preprocess and these sloppinesses ccache serves such sources too.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
endfunction()
