// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/html_page.h"

#include "core/image_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace pnr {

namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light dark; --ink: #222; --paper: #fbfaf7; --rule: #ccc6bb; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8e4dc; --paper: #1c1b19; --rule: #4a463f; --bad: #ff8a80; } }
body { font: 16px/1.5 Georgia, serif; color: var(--ink); background: var(--paper); max-width: 70rem; margin: 2rem auto; padding: 0 1.5rem; }
h1, h2 { font-weight: normal; line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid var(--rule); }
table { border-collapse: collapse; font: 14px/1.4 ui-monospace, monospace; width: 100%; }
th, td { text-align: left; padding: .2rem .8rem .2rem 0; border-bottom: 1px solid var(--rule); vertical-align: top; }
.wide { overflow-x: auto; } th { cursor: pointer; } td.number { text-align: right; } tr.bad td { color: var(--bad); font-weight: bold; }
figure { display: inline-block; margin: .5rem 1rem .5rem 0; vertical-align: top; } figcaption { font-size: 13px; }
figure img { display: block; max-width: 100%; height: auto; cursor: zoom-in; } figure.grown { display: block; } figure.grown img { width: 100%; image-rendering: pixelated; }
svg text { font: 12px ui-monospace, monospace; fill: var(--ink); } svg .axis { stroke: var(--rule); fill: none; }
.legend span { display: inline-block; margin-right: 1.2rem; font-size: 14px; } .legend i { display: inline-block; width: .8em; height: .8em; margin-right: .4em; }
)";

constexpr std::string_view script = R"(
for (const head of document.querySelectorAll('th')) head.onclick = () => {
  const table = head.closest('table'), column = [...head.parentNode.children].indexOf(head);
  const rows = [...table.tBodies[0].rows], down = head.dataset.down = head.dataset.down ? '' : '1';
  const key = row => { const t = row.cells[column].textContent, n = parseFloat(t); return isNaN(n) ? t : n; };
  rows.sort((a, b) => (key(a) > key(b) ? 1 : key(a) < key(b) ? -1 : 0) * (down ? 1 : -1));
  rows.forEach(row => table.tBodies[0].append(row));
};
for (const figure of document.querySelectorAll('figure')) figure.onclick = () => figure.classList.toggle('grown');
)";

constexpr std::array<const char*, 8> inks{"#2f6db3", "#c2562d", "#3f8f4f", "#8a5cb0",
                                          "#b58a12", "#3b9aa8", "#b0477d", "#7a7a7a"};

std::string base64(const std::vector<unsigned char>& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned word = 0;
        for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

bool is_number(const std::string& cell) {
    return !cell.empty() && cell.find_first_not_of("0123456789.+-e %inf") == std::string::npos;
}

// A logarithmic scale over what the lines hold, widened to half decades.
struct LogScale {
    double low = infinity, high = -infinity; // decades
    double begin = 0, end = 1;               // in the drawing
    void take(double value) {
        low = std::min(low, std::log10(value));
        high = std::max(high, std::log10(value));
    }
    void widen() {
        low = std::floor(2 * low - 0.1) / 2;
        high = std::ceil(2 * high + 0.1) / 2;
    }
    double at(double value) const { return begin + (std::log10(value) - low) / (high - low) * (end - begin); }
};

std::string grid(const LogScale& across, const LogScale& up) {
    std::string svg = fmt::format(R"(<path class="axis" d="M{0} {2}H{1}M{0} {2}V{3}"/>)", across.begin,
                                  across.end, up.begin, up.end);
    const auto label = [](double value) {
        return value >= 0.01 && value < 10000 ? fmt::format("{:g}", value) : fmt::format("{:.0e}", value);
    };
    for (const bool sideways : {true, false}) {
        const LogScale& scale = sideways ? across : up;
        for (int decade = static_cast<int>(std::floor(scale.low)); decade <= scale.high; ++decade) {
            for (const double step : {1.0, 2.0, 5.0}) {
                const double value = step * std::pow(10.0, decade), place = std::log10(value);
                if (place < scale.low - 1e-9 || place > scale.high + 1e-9) continue;
                if (step != 1 && scale.high - scale.low > 2.1) continue;
                if (sideways)
                    svg += fmt::format(
                        R"(<path class="axis" d="M{0:.1f} {1}v5"/><text x="{0:.1f}" y="{2}" text-anchor="middle">{3}</text>)",
                        scale.at(value), up.begin, up.begin + 18, label(value));
                else
                    svg += fmt::format(
                        R"(<path class="axis" d="M{0} {1:.1f}h-5"/><text x="{2}" y="{3:.1f}" text-anchor="end">{4}</text>)",
                        across.begin, scale.at(value), across.begin - 8, scale.at(value) + 4, label(value));
            }
        }
    }
    return svg;
}

} // namespace

std::string html_text(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '&')
            escaped += "&amp;";
        else if (c == '<')
            escaped += "&lt;";
        else if (c == '>')
            escaped += "&gt;";
        else if (c == '"')
            escaped += "&quot;";
        else
            escaped += c;
    }
    return escaped;
}

std::string html_table(const HtmlTable& table) {
    std::string html = "<div class=\"wide\"><table><thead><tr>";
    for (const std::string& head : table.head) html += "<th>" + html_text(head) + "</th>";
    html += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        html += i < table.bad.size() && table.bad[i] ? "<tr class=\"bad\">" : "<tr>";
        for (const std::string& cell : table.rows[i])
            html += (is_number(cell) ? "<td class=\"number\">" : "<td>") + html_text(cell) + "</td>";
        html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
}

std::string table_text(const HtmlTable& table) {
    std::vector<std::vector<std::string>> rows{table.head};
    rows.insert(rows.end(), table.rows.begin(), table.rows.end());
    std::vector<std::size_t> widths(table.head.size(), 0);
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i)
            line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string html_picture(const Image<Color>& linear, const std::string& caption, int width) {
    return fmt::format("<figure><img width=\"{}\" alt=\"{}\" "
                       "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                       width, html_text(caption), base64(encode_png(linear, {}, {})), html_text(caption));
}

std::string html_log_plot(const std::string& title, const std::string& x, const std::string& y,
                          const std::vector<PlotLine>& lines) {
    LogScale across, up;
    across.begin = 70, across.end = 660, up.begin = 360, up.end = 20;
    for (const PlotLine& line : lines) {
        for (const auto& [px, py] : line.points) {
            if (!(px > 0 && py > 0) || !std::isfinite(px + py)) continue;
            across.take(px), up.take(py);
        }
    }
    if (!(across.low <= across.high)) return "";
    across.widen(), up.widen();
    std::string svg = grid(across, up), legend;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const char* ink = inks[i % inks.size()];
        std::string path, dots;
        for (const auto& [px, py] : lines[i].points) {
            if (!(px > 0 && py > 0) || !std::isfinite(px + py)) continue;
            path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", across.at(px), up.at(py));
            dots += fmt::format(
                R"(<circle cx="{:.1f}" cy="{:.1f}" r="3.5" fill="{}"><title>{}: {:.3g}, {:.3g}</title></circle>)",
                across.at(px), up.at(py), ink, html_text(lines[i].name), px, py);
        }
        svg += fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="2"{}/>)", path, ink,
                           lines[i].dashed ? " stroke-dasharray=\"6 5\"" : "");
        if (!lines[i].dashed) svg += dots;
        legend +=
            fmt::format("<span><i style=\"background:{}\"></i>{}</span>", ink, html_text(lines[i].name));
    }
    return fmt::format(
        "<h3>{}</h3><svg viewBox=\"0 0 700 410\" width=\"700\" role=\"img\">{}<text x=\"660\" y=\"400\" "
        "text-anchor=\"end\">{}</text><text x=\"75\" y=\"14\">{}</text></svg><p class=\"legend\">{}</p>\n",
        html_text(title), svg, html_text(x), html_text(y), legend);
}

std::string html_bar(const std::vector<std::pair<std::string, double>>& parts, const std::string& unit) {
    double whole = 0;
    for (const auto& [name, value] : parts) whole += value;
    if (!(whole > 0)) return "";
    std::string bar, legend;
    double from = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto& [name, value] = parts[i];
        if (value <= 0) continue;
        const char* ink = inks[i % inks.size()];
        bar += fmt::format(
            R"(<rect x="{:.2f}" y="0" width="{:.2f}" height="26" fill="{}"><title>{}: {:.3g} {}</title></rect>)",
            from, value / whole * 700, ink, html_text(name), value, unit);
        from += value / whole * 700;
        legend += fmt::format("<span><i style=\"background:{}\"></i>{} {:.3g} {}</span>", ink,
                              html_text(name), value, unit);
    }
    return fmt::format(
        "<svg viewBox=\"0 0 700 26\" width=\"700\" role=\"img\">{}</svg><p class=\"legend\">{}</p>\n", bar,
        legend);
}

std::string html_page(const std::string& title, const std::string& body) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
        "content=\"width=device-width\"><title>{0}</title><style>{1}</style></head>\n<body><h1>{0}</h1>\n{2}"
        "<script>{3}</script></body></html>\n",
        html_text(title), style, body, script);
}

} // namespace pnr
