#!/bin/sh
# citations.sh ROOT: every key that a source cites, as in [PieglTiller97], must be in REFERENCES.md.
# Prints "file:line: rule" for each that is not; exit code 1 if there are any.
set -eu
cd "$1"
missing=$(find iga meshing rom io drivers verification tests \( -name '*.h' -o -name '*.cpp' \) \
    -exec grep -noE '\[[A-Z][A-Za-z]*[a-z][0-9]{2}([0-9]{2})?[a-z]?\]' /dev/null {} + 2>/dev/null |
    while IFS=: read -r file line key; do
        grep -qF -- "**$key**" REFERENCES.md ||
            echo "$file:$line: $key is not in REFERENCES.md; add it with its full data"
    done)
[ -z "$missing" ] || { echo "$missing"; exit 1; }
