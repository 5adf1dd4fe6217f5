// SPDX-License-Identifier: GPL-3.0-or-later
// Features of POV-Ray's that we know and lack.
#include "parser/blocks.h"

#include <fmt/format.h>

namespace pnr {

void warn_unsupported(Parser& p, const Token& at, std::string_view feature, std::string_view consequence) {
    if (p.left_out.contains(feature)) return;
    p.left_out.emplace(feature);
    warn(p, at, fmt::format("`{}` is not supported: {}", feature, consequence));
}

void skip_block(Parser& p, std::string_view what) {
    open_block(p, what);
    for (int depth = 1; depth > 0;) {
        if (at(p, '{'))
            open_block(p, what), ++depth;
        else if (close_block(p))
            --depth;
        else
            next(p);
    }
}

void skip_argument(Parser& p, std::string_view what) {
    if (at(p, '{'))
        skip_block(p, what);
    else if (at_expression(p))
        parse_color(p);
}

} // namespace pnr
