#!/usr/bin/env bash
# launcher_test.sh ROOT WORK: the launcher in a small project of the same shape, in a path with a
# space, with a made-up package manager.
set -euo pipefail
launcher=$1/couture
rm -rf "$2"
tree="$2/a tree"
mkdir -p "$tree/cmake" "$tree/drivers" "$2/stubs" "$2/elsewhere"
cp "$launcher" "$tree/couture"

# The project: a program that prints its arguments and the size of the file that it is given.
cat >"$tree/CMakePresets.json" <<'END'
{ "version": 6, "configurePresets": [
  { "name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release" } ] }
END
cat >"$tree/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.25)
project(small LANGUAGES C)
option(COUTURE_TESTS "" ON)
add_subdirectory(drivers)
if(COUTURE_TESTS)
    enable_testing()
    add_test(NAME good COMMAND true)
    add_test(NAME bad COMMAND false)
endif()
END
echo 'add_executable(couture main.c)' >"$tree/drivers/CMakeLists.txt"
cat >"$tree/drivers/main.c" <<'END'
#include <stdio.h>
int main(int n, char** arguments) {
    for (int i = 1; i < n; ++i) printf("[%s]", arguments[i]);
    FILE* file = n > 1 ? fopen(arguments[1], "r") : 0;
    printf(" %s\n", file ? "read" : "not read");
    return file ? 0 : 7;
}
END
printf 'one # for this\n\n# and\ntwo\n' >"$tree/cmake/packages.txt"
echo three >"$tree/cmake/packages_test.txt"

# The package manager: package one is there, the rest is not; sudo is as good as root.
cat >"$2/stubs/dpkg-query" <<'END'
#!/bin/sh
echo "installed one"
echo "deinstall two"
END
cat >"$2/stubs/apt-get" <<END
#!/bin/sh
echo "\$DEBIAN_FRONTEND: \$*" >>"$2/apt.log"
END
cat >"$2/stubs/sudo" <<'END'
#!/bin/sh
[ "$1" = -v ] || exec "$@"
END
chmod +x "$2"/stubs/*

work=$2
fail() { echo "launcher_test: $*"; cat "$work/out" "$work/err" 2>/dev/null; exit 1; }
call() { # EXIT-CODE COMMAND...: output into out and err
    local code=0
    "${@:2}" >"$work/out" 2>"$work/err" || code=$?
    [ "$code" -eq "$1" ] || fail "exit code $code, expected $1: ${*:2}"
}
says() { grep -qF -- "$2" "$work/$1" || fail "'$2' is missing in $1"; }
silent() { [ ! -s "$work/$1" ] || fail "$1 is not empty"; }

cd "$work/elsewhere"
echo data >"a file.txt"
ln -s "$tree/couture" link

# The first call builds; files are those of the caller's directory; the output is the program's.
call 0 "$tree/couture" --no-setup "a file.txt" '*'
[ "$(cat "$work/out")" = '[a file.txt][*] read' ] || fail "wrong output"
says err "building"
# The second has nothing to say, also through a link.
call 0 ./link --no-setup "a file.txt"
silent err
# Exit codes are the program's.
call 7 ./link --no-setup missing.txt
[ ! -e "$work/apt.log" ] || fail "--no-setup must not install"

# What is missing is installed in one go, after it was said.
if grep -qsE '^ID(_LIKE)?=.*\b(debian|ubuntu)\b' /etc/os-release; then
    PATH=$work/stubs:$PATH call 0 ./link "a file.txt"
    says err "installing with apt-get: two "
    grep -qE '^noninteractive: .*install --no-install-recommends two$' "$work/apt.log" ||
        fail "wrong call of apt-get: $(cat "$work/apt.log")"
    PATH=$work/stubs:$PATH call 0 ./link build
    PATH=$work/stubs:$PATH call 8 ./link test
    grep -q 'recommends three two$' "$work/apt.log" || fail "test packages were not asked for"
fi

# Tests: ctest's own arguments, closing lines and exit code; back to a plain run without a word.
call 8 ./link --no-setup test
says out "50% tests passed"
call 0 ./link --no-setup test -R good
call 8 ./link --no-setup test -R no_such_test
call 0 ./link --no-setup "a file.txt"
silent err

# Changed CMake files and sources are noticed; a failed build shows why and where to read on.
echo 'target_compile_options(couture PRIVATE -DX)' >>"$tree/drivers/CMakeLists.txt"
call 0 ./link --no-setup "a file.txt"
says err "building"
echo 'broken' >>"$tree/drivers/main.c"
call 1 ./link --no-setup "a file.txt"
says err "main.c"
says err "$tree/build/build.log"
sed -i '$d' "$tree/drivers/main.c"

# Two at once wait for one another.
echo '// changed' >>"$tree/drivers/main.c"
./link --no-setup "a file.txt" >"$work/first" 2>&1 &
call 0 ./link --no-setup "a file.txt"
wait $! || fail "the first of two failed: $(cat "$work/first")"

# A tree that was moved is configured anew.
mv "$tree" "$work/moved"
call 0 "$work/moved/couture" --no-setup "a file.txt"
says out "read"
