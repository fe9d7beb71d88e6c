#!/bin/sh
# listed_sources.sh ROOT COMPILE_COMMANDS: every .cpp below ROOT's source folders must be compiled,
# that is, be listed in a CMakeLists.txt. Prints those that are not; exit code 1 if there are any.
set -eu
cd "$1"
root=$(pwd -P)
unlisted=$(find iga meshing rom io drivers verification tests -name '*.cpp' \
    ! -path 'tests/install/consumer/*' 2>/dev/null |
    while read -r file; do
        grep -qF "\"file\": \"$root/$file\"" "$2" ||
            echo "$file: listed in no CMakeLists.txt; name it in that of its folder"
    done)
[ -z "$unlisted" ] || { echo "$unlisted"; exit 1; }
