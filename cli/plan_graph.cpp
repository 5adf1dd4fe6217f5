// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/plan_graph.h"

#include "cli/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace pnr {

namespace {

// Three rows: paint above, light in the middle, what the eye sees below.
struct Node {
    const char* title;
    int column, row;
    const char* decision;  // its name in Plan::left_out; "": always there
    const char* kept;      // its name there when an earlier run's is used again
    const char* pass;      // its name in Forecast::passes
    const char* structure; // its name in Forecast::structures
    const char* part = ""; // a decision about a part of it, which goes on without
};
constexpr std::array nodes = {
    Node{"scene", 0, 1, "", "", "parse", ""},
    Node{"BVH", 1, 1, "", "", "build", "bvh"},
    Node{"photon pass", 2, 1, "photon pass", "photons", "photons", "photons"},
    Node{"kd-tree", 3, 1, "kd-tree", "photons", "kdtree", "kdtree"},
    Node{"caustic map", 4, 1, "caustic map", "photons", "", ""},
    Node{"photon normals", 2, 0, "photon normals", "photons", "", ""},
    Node{"sparse map", 3, 0, "npr pass", "sparse", "sparse", ""},
    Node{"orientation", 4, 0, "npr pass", "", "orient", "", "rbf solve"},
    Node{"informative map", 5, 0, "npr pass", "", "informative", ""},
    Node{"ILIC", 6, 0, "ilic", "", "ilic", "paint"},
    Node{"G-buffer", 2, 2, "", "gbuffer", "gbuffer", "gbuffer"},
    Node{"rendering pass", 4, 2, "rendering pass", "render", "render", ""},
    Node{"picture", 6, 2, "", "", "write", "picture"},
};
struct Edge {
    int from, to; // numbers of nodes
};
constexpr std::array edges = {Edge{0, 1},  Edge{1, 2},  Edge{1, 10},  Edge{2, 3},  Edge{3, 4}, Edge{2, 5},
                              Edge{5, 6},  Edge{10, 6}, Edge{6, 7},   Edge{7, 8},  Edge{8, 9}, Edge{9, 12},
                              Edge{3, 11}, Edge{4, 11}, Edge{10, 11}, Edge{11, 12}};

constexpr int box_width = 164, box_height = 88, step_x = 208, step_y = 138, margin = 24, head = 64;
int left(const Node& node) { return margin + node.column * step_x; }
int top(const Node& node) { return head + margin + node.row * step_y; }

std::string_view why_left_out(const Plan& plan, std::string_view what) {
    for (const LeftOut& left_out : plan.left_out)
        if (!what.empty() && left_out.what == what) return left_out.why;
    return {};
}

// Lines of at most `width` letters, broken between words, `most` of them.
std::vector<std::string> broken(std::string_view text, std::size_t width, std::size_t most) {
    std::vector<std::string> lines(1);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(' '), text.size());
        const std::string_view word = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
        lines.back() += fmt::format("{}{}", lines.back().empty() ? "" : " ", word);
    }
    if (lines.size() > most) {
        lines.resize(most);
        lines.back() += " ...";
    }
    return lines;
}

std::vector<std::string> costs(const Node& node, const Forecast& forecast) {
    std::vector<std::string> lines;
    for (const PassForecast& pass : forecast.passes)
        if (pass.name == node.pass)
            lines.push_back(fmt::format("{:.2f} s, {:.0f} %", pass.cpu_s, 100 * pass.share));
    for (const StructureSize& size : forecast.structures)
        if (size.name == node.structure)
            lines.push_back(fmt::format("{:.1f} MB", size.bytes / (1024 * 1024)));
    return lines;
}

std::string drawn(const Node& node, const Plan& plan, const Forecast& forecast) {
    const std::string_view gone = why_left_out(plan, node.decision), kept = why_left_out(plan, node.kept);
    const std::string_view why = gone.empty() ? kept : gone;
    const char* look = !gone.empty() ? "gone" : !kept.empty() ? "kept" : "used";
    constexpr std::size_t letters = 26, most = 4;
    auto lines = why.empty() ? costs(node, forecast) : broken(why, letters, most);
    if (const std::string_view without = why_left_out(plan, node.part); why.empty() && !without.empty())
        for (std::string& line : broken(fmt::format("no {}: {}", node.part, without), letters, most - 1))
            lines.push_back(std::move(line));
    std::string text =
        fmt::format("<g class=\"{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"6\"/>\n", look,
                    left(node), top(node), box_width, box_height);
    const int middle = left(node) + box_width / 2;
    int y = top(node) + 20;
    text +=
        fmt::format("<text class=\"title\" x=\"{}\" y=\"{}\">{}</text>\n", middle, y, html_text(node.title));
    for (const std::string& line : lines)
        text += fmt::format("<text x=\"{}\" y=\"{}\">{}</text>\n", middle, y += 16, html_text(line));
    return text + "</g>\n";
}

bool is_gone(const Node& node, const Plan& plan) { return !why_left_out(plan, node.decision).empty(); }

// From side to side; between boxes of one column from below one to above the other.
std::string drawn(const Edge& edge, const Plan& plan) {
    const Node& from = nodes[static_cast<std::size_t>(edge.from)];
    const Node& to = nodes[static_cast<std::size_t>(edge.to)];
    const char* look = is_gone(from, plan) || is_gone(to, plan) ? "gone" : "used";
    if (from.column == to.column) {
        const bool down = from.row < to.row;
        const int x = left(from) + box_width / 2;
        return fmt::format("<path class=\"{}\" d=\"M{},{}V{}\" marker-end=\"url(#{})\"/>\n", look, x,
                           top(from) + (down ? box_height : 0), top(to) + (down ? -8 : box_height + 8), look);
    }
    const int x0 = left(from) + box_width, x1 = left(to) - 8;
    const int y0 = top(from) + box_height / 2, y1 = top(to) + box_height / 2;
    const int bend = (step_x - box_width) / 2; // turns in the gap before the box that it leads to
    if (y0 == y1)
        return fmt::format("<path class=\"{0}\" d=\"M{1},{2}H{3}\" marker-end=\"url(#{0})\"/>\n", look, x0,
                           y0, x1);
    return fmt::format(
        "<path class=\"{0}\" d=\"M{1},{2}C{3},{2} {3},{4} {5},{4}\" marker-end=\"url(#{0})\"/>\n", look, x0,
        y0, x0 + bend + 6, y1, x1);
}

constexpr std::string_view looks = R"(<style>
text { font: 12px sans-serif; text-anchor: middle; fill: #333 }
text.title { font-weight: bold; font-size: 14px; fill: #111 }
text.head { text-anchor: start; font-size: 15px }
.used rect { fill: #fdf3dc; stroke: #a06a1c; stroke-width: 1.5 }
.kept rect { fill: #e2eefa; stroke: #3a6ea5; stroke-width: 1.5 }
.gone rect { fill: #f4f4f4; stroke: #aaa; stroke-dasharray: 5 4 }
.gone text, .gone text.title { fill: #888 }
path { fill: none; stroke-width: 1.5 }
path.used { stroke: #a06a1c } path.gone { stroke: #bbb; stroke-dasharray: 5 4 }
</style>
<defs><marker id="used" markerWidth="8" markerHeight="8" refX="1" refY="4" orient="auto"><path d="M0,0L8,4L0,8z" style="fill:#a06a1c"/></marker>
<marker id="gone" markerWidth="8" markerHeight="8" refX="1" refY="4" orient="auto"><path d="M0,0L8,4L0,8z" style="fill:#bbb"/></marker></defs>
)";

} // namespace

std::string plan_graph(const Plan& plan, const Forecast& forecast) {
    double sum = 0;
    for (const PassForecast& pass : forecast.passes) sum += pass.cpu_s;
    const int width = 2 * margin + 6 * step_x + box_width,
              height = head + 2 * margin + 2 * step_y + box_height;
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
        "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n{2}"
        "<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
        width, height, looks);
    text += fmt::format("<text class=\"head\" x=\"{}\" y=\"32\">{} x {} pixels, {} photons: {:.1f} s of "
                        "processor time foretold. "
                        "Dashed: left out. Blue: of an earlier run, used again.</text>\n",
                        margin, forecast.width, forecast.height, forecast.photons, sum);
    const std::array rows = {"paint", "light", "what the eye sees"};
    for (std::size_t row = 0; row < rows.size(); ++row)
        text += fmt::format("<text class=\"head\" x=\"{}\" y=\"{}\">{}</text>\n", margin,
                            head + margin + static_cast<int>(row) * step_y - 8, rows[row]);
    for (const Edge& edge : edges) text += drawn(edge, plan);
    for (const Node& node : nodes) text += drawn(node, plan, forecast);
    return text + "</svg>\n";
}

} // namespace pnr
