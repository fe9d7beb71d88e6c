#include "io/text_cursor.h"

#include <catch2/catch.hpp>

using namespace couture;

TEST_CASE("TextCursor: words, numbers and lines", "[io]") {
    io::TextCursor words("f", "a 1.5 # skipped 7\n\n +2e-3, 4", '#', ",");
    words.expect("a");
    CHECK(words.number("x") == 1.5);
    CHECK(words.number("y") == 2e-3);
    CHECK(words.where() == "f:3");
    CHECK(words.integer("n", 0, 5) == 4);
    CHECK(words.at_end());
    CHECK_THROWS_WITH(words.word("a name"), "f:3: the file ends here; expected a name");
}

TEST_CASE("TextCursor: errors name file, line, what was found and expected", "[io]") {
    io::TextCursor words("f", "x\nnan inf 1e999 7 1");
    CHECK_THROWS_WITH(words.expect("y"), "f:1: found 'x'; expected 'y'");
    CHECK_THROWS_WITH(words.number("a knot"), "f:2: found 'nan'; expected a finite number: a knot");
    CHECK_THROWS_WITH(words.number("a knot"), "f:2: found 'inf'; expected a finite number: a knot");
    CHECK_THROWS_WITH(words.number("a knot"), "f:2: found '1e999'; expected a number: a knot");
    CHECK_THROWS_WITH(words.integer("a side", 1, 6),
                      "f:2: found '7'; expected a side, a whole number from 1 to 6");
    CHECK_THROWS_WITH(words.numbers(1'000'000'000'000, "points"),
                      "f:2: the file holds at most 1 more numbers; expected 1000000000000: points");
    CHECK_THROWS_WITH(words.expect_end("the list"),
                      "f:2: found '1' after the last of the list; expected nothing more");
}
