// SPDX-License-Identifier: GPL-3.0-or-later
// Reports as one page that needs nothing else: no network, and no scripts to be complete (with them, tables
// sort by a click on a column's head and pictures grow).
#pragma once

#include "core/image.h"
#include "core/types.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pnr {

std::string html_text(std::string_view text); // escaped

struct HtmlTable {
    std::vector<std::string> head;              // plain text
    std::vector<std::vector<std::string>> rows; // likewise
    std::vector<bool> bad;                      // rows that are shown as failed; may be shorter than rows
};
std::string html_table(const HtmlTable& table);
std::string table_text(const HtmlTable& table); // for a terminal: columns as wide as they must be

// A picture of linear light as an embedded PNG, shown `width` wide. Throws FileError where the image library
// is missing.
std::string html_picture(const Image<Color>& linear, const std::string& caption, int width);

struct PlotLine {
    std::string name;
    std::vector<std::pair<double, double>> points; // those not above 0 are left out
    bool dashed = false;
};
// Lines over logarithmic axes; "" if there is nothing to show.
std::string html_log_plot(const std::string& title, const std::string& x, const std::string& y,
                          const std::vector<PlotLine>& lines);
// Shares of a whole as one bar with its legend.
std::string html_bar(const std::vector<std::pair<std::string, double>>& parts, const std::string& unit);

// The whole page. `body` is HTML.
std::string html_page(const std::string& title, const std::string& body);

} // namespace pnr
