// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/commands.h"

int main(int count, char** words) { return pnr::run_program({words + 1, words + count}); }
