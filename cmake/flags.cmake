# Flags of our own code; third parties come in as SYSTEM. Linked PRIVATE by every target. Installed
# without content: the flags are no business of an outside program.
add_library(couture_flags INTERFACE)
# Left out on purpose: -ffast-math. GCC's default -ffp-contract=fast stays: fused multiply-adds are
# half of the peak and change no result from run to run. That results do not depend on the number
# of threads is due to the loops, which give every sum to one thread in a fixed order.
target_compile_options(couture_flags INTERFACE $<BUILD_INTERFACE:
    -Wall -Wextra -Wpedantic -Wshadow -Werror
    -fno-math-errno
    # What g++ 12's optimizer warns of depends on the instruction set, and is wrong of Eigen's small
    # vectors with AVX, of fmt's buffers, and of its own AVX-512 intrinsics: the first are silenced,
    # the others of that kind must not stop a build on a machine that we have not seen.
    $<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds -Wno-stringop-overflow -Wno-maybe-uninitialized
        -Wno-uninitialized
        # Vectors that never leave one source are no matter of the ABI.
        -Wno-psabi
        -Wno-error=stringop-overread -Wno-error=restrict -Wno-error=free-nonheap-object
        -Wno-error=dangling-pointer -Wno-error=use-after-free -Wno-error=nonnull>
    $<$<AND:$<BOOL:${COUTURE_NATIVE}>,$<CONFIG:Release>>:-march=native>>)

# Eigen aligns as the instruction set asks: 16 bytes in general, 32 with AVX, 64 with AVX-512, and
# what was allocated under one setting cannot be freed under another. We compile with
# -march=native, a program that uses the installed libraries need not: both are held to the same
# values, PUBLIC on couture_iga. 64 on the heap is the largest that Eigen can ask for; fixed-size
# members keep AVX's 32.
set(COUTURE_ABI_DEFINITIONS EIGEN_MAX_ALIGN_BYTES=64 EIGEN_MAX_STATIC_ALIGN_BYTES=32)

if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer -O1)
    add_link_options(-fsanitize=address,undefined)
    add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
