# Flags of our own code; third parties come in as SYSTEM.
add_library(couture_flags INTERFACE)
target_compile_options(couture_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Werror
    $<$<CONFIG:Release>:-O3>
    $<$<AND:$<BOOL:${COUTURE_NATIVE}>,$<CONFIG:Release>>:-march=native>)
# One rounding everywhere: results do not depend on how loops were split among threads.
target_compile_options(couture_flags INTERFACE -fno-math-errno)
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
    add_compile_options(-fsanitize=address,undefined -fno-omit-frame-pointer -O1)
    add_link_options(-fsanitize=address,undefined)
    add_compile_definitions(_GLIBCXX_ASSERTIONS)
endif()
