// SPDX-License-Identifier: GPL-3.0-or-later
// Long lists of plain numbers (those of `mesh2`) stay text: no tokens are made of them, and their reader
// takes the numbers straight into its arrays.
#pragma once

#include <cstddef>

namespace pnr {

// The end of a run of plain numbers and vectors of them, separated by optional commas, blanks and `//`
// comments, that goes from `at` up to a `}`: where that brace stands. Null if anything else is in between: a
// name, an operator, a directive.
const char* end_of_number_run(const char* at, const char* end);

// Reads a run that end_of_number_run has found.
struct NumberReader {
    const char* at;
    const char* end;

    bool at_end(); // these three pass blanks, commas and comments before
    bool at_vector();
    bool at_number();
    // `<a, b ...>`, `count` numbers at most; false if there are more or none stands here. Numbers that are
    // not there stay as they are; `found` tells how many were.
    bool vector(double* numbers, std::size_t count, std::size_t& found);
    double number(); // at_number() must hold; too large ones are infinite
};

} // namespace pnr
