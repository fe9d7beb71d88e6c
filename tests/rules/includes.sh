#!/bin/sh
# includes.sh ROOT: checks every #include of the sources below ROOT against folders.txt and
# foreign_headers.txt. Prints "file:line: rule" for each that is broken; exit code 1 if any is.
set -eu
rules=$(cd "$(dirname "$0")" && pwd)
cd "$1"
# The outside program of tests/install sees the installed headers only.
find iga meshing rom io drivers verification tests \( -name '*.h' -o -name '*.cpp' \) \
    ! -path 'tests/install/consumer/*' 2>/dev/null | LC_ALL=C sort |
    awk -v folders="$rules/folders.txt" -v headers="$rules/foreign_headers.txt" '
function broken(text) { printf "%s:%d: %s\n", file, n_line, text; n_broken++ }

# The folder of the table that a file is in, or "".
function folder_of(path,    part, two) {
    split(path, part, "/")
    two = part[1] "/" part[2]
    sub(/\.(h|cpp)$/, "", two)
    return two in allowed ? two : part[1] in allowed ? part[1] : ""
}

function check_own(header,    from, to, module) {
    if ((getline ignored < header) < 0)
        return broken("\"" header "\" is no file; includes start at the root of the repository")
    close(header)
    from = folder_of(file); to = folder_of(header)
    if (from == "") return broken("is in no folder of tests/rules/folders.txt")
    if (to == "") return broken("\"" header "\" is in no folder of tests/rules/folders.txt")
    module = to; sub(/\/.*/, "", module)
    if (from != to && !index(allowed[from], " " to " ") && !index(allowed[from], " " module " "))
        broken(from " must not include " to " (\"" header "\"); it may include:" allowed[from])
}

function check_foreign(header,    i) {
    if (file ~ /^(tests|verification)\// || header ~ /^[a-z_0-9]+$/) return
    for (i = 1; i <= n_headers; i++)
        if (header ~ "^(" header_pattern[i] ")$") {
            if (file !~ "^(" file_pattern[i] ")$")
                broken("<" header "> belongs into files like " file_pattern[i] " only")
            return
        }
    broken("<" header "> is in no line of tests/rules/foreign_headers.txt")
}

BEGIN {
    while ((getline line < folders) > 0)
        if (line ~ /^[a-z]/) {
            split(line, part, ":")
            allowed[part[1]] = part[2] " "
            gsub(/ +/, " ", allowed[part[1]])
        }
    while ((getline line < headers) > 0)
        if (line !~ /^(#|$)/) {
            split(line, part, " ")
            header_pattern[++n_headers] = part[1]
            file_pattern[n_headers] = part[2]
        }
}
{
    file = $0
    n_line = 0
    while ((getline line < file) > 0) {
        n_line++
        if (line !~ /^[ \t]*#[ \t]*include/) continue
        name = line
        sub(/^[^"<]*["<]/, "", name)
        sub(/[">].*/, "", name)
        if (line ~ /include[ \t]*"/) check_own(name); else check_foreign(name)
    }
    close(file)
    n_files++
}
END {
    if (n_files == 0) { print "no sources found"; exit 1 }
    printf "%d files, %d broken rules\n", n_files, n_broken
    exit n_broken > 0
}'
