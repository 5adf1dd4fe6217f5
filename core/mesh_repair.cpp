// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/mesh_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/Euler_operations.h>
#include <CGAL/subdivision_method_3.h>

#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace pnr {

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
namespace collapse = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using HalfedgeMesh = CGAL::Surface_mesh<Point>;
using Polygon = std::vector<std::size_t>;

constexpr std::size_t most_triangles = std::size_t{1} << 26;
// Beyond so many edges, a hole that is no plain Delaunay case is left open: the thorough search is cubic.
constexpr std::size_t long_border = 500;

// Triangles without neighbours, as files hold them.
struct Soup {
    std::vector<Point> points;
    std::vector<Polygon> polygons;
};

std::string plural(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

// What was done, in words.
struct Report {
    std::vector<std::string> done;
    void count(std::size_t n, const char* what, const char* fate) {
        if (n > 0) done.push_back(fmt::format("{} {}", plural(n, what), fate));
    }
    void say(bool so, const char* what) {
        if (so) done.emplace_back(what);
    }
};

Soup to_soup(const MeshData& data) {
    Soup soup;
    soup.points.reserve(data.positions.size());
    for (const Vec3f& p : data.positions) soup.points.emplace_back(p.x, p.y, p.z);
    soup.polygons.reserve(data.triangles.size());
    for (const auto& t : data.triangles) soup.polygons.push_back({t[0], t[1], t[2]});
    return soup;
}

// Triangles that name a vertex twice make no halfedge mesh, and vertices that lie in one place no closed one.
void clean(Soup& soup, Report& report) {
    report.count(pmp::merge_duplicate_points_in_polygon_soup(soup.points, soup.polygons), "vertex use",
                 "joined to its equal");
    const std::size_t thin = std::erase_if(
        soup.polygons, [](const Polygon& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    report.count(thin, "triangle", "without three corners taken out");
    const std::size_t twice = pmp::merge_duplicate_polygons_in_polygon_soup(soup.points, soup.polygons);
    report.count(twice, "triangle", "there already taken out");
    pmp::remove_isolated_points_in_polygon_soup(soup.points, soup.polygons);
}

bool same_winding(const Soup& a, const Soup& b, std::size_t triangle) {
    const Polygon &t = a.polygons[triangle], &u = b.polygons[triangle];
    for (std::size_t turn = 0; turn < 3; ++turn)
        if (a.points[t[0]] == b.points[u[turn]]) return a.points[t[1]] == b.points[u[(turn + 1) % 3]];
    return false;
}

// A halfedge mesh: neighbours agree in their winding, and edges have one or two triangles.
HalfedgeMesh connect(Soup& soup, Report& report) {
    const Soup before = soup;
    const bool manifold = pmp::orient_polygon_soup(soup.points, soup.polygons);
    std::size_t turned = 0;
    for (std::size_t i = 0; i < soup.polygons.size(); ++i) turned += !same_winding(before, soup, i);
    report.say(turned > 0, "windings made to agree");
    report.say(!manifold, "cut apart where it is no surface");
    HalfedgeMesh mesh;
    pmp::polygon_soup_to_polygon_mesh(soup.points, soup.polygons, mesh);
    return mesh;
}

// The best lid over the border's own vertices [Liepa 2003]; false, with the mesh unchanged, where CGAL finds
// none.
bool close_well(HalfedgeMesh& mesh, HalfedgeMesh::Halfedge_index border, std::size_t length) {
    std::vector<HalfedgeMesh::Face_index> lid;
    try {
        pmp::triangulate_hole(mesh, border, std::back_inserter(lid),
                              pmp::parameters::do_not_use_cubic_algorithm(length > long_border));
    } catch (const CGAL::Failure_exception&) { // of weighing candidates that lie on a line
        return false;
    }
    return !lid.empty();
}

// A fan about the middle of the border, which always is a surface, if not always a fair one.
void close_by_fan(HalfedgeMesh& mesh, HalfedgeMesh::Halfedge_index border, const Point& middle) {
    CGAL::Euler::fill_hole(border, mesh);
    mesh.point(mesh.target(CGAL::Euler::add_center_vertex(border, mesh))) = middle;
}

void close_holes(HalfedgeMesh& mesh, Report& report) {
    std::vector<HalfedgeMesh::Halfedge_index> borders;
    pmp::extract_boundary_cycles(mesh, std::back_inserter(borders));
    for (const HalfedgeMesh::Halfedge_index border : borders) {
        std::size_t length = 0;
        Kernel::Vector_3 sum = CGAL::NULL_VECTOR;
        for (auto h = border; length == 0 || h != border; h = mesh.next(h), ++length)
            sum = sum + (mesh.point(mesh.target(h)) - CGAL::ORIGIN);
        if (!close_well(mesh, border, length))
            close_by_fan(mesh, border, CGAL::ORIGIN + sum / static_cast<double>(length));
    }
    report.count(borders.size(), "hole", "closed");
}

// Each piece by the sign of its own volume.
void turn_pieces(HalfedgeMesh& mesh) {
    const auto piece = mesh.add_property_map<HalfedgeMesh::Face_index, std::size_t>("f:piece").first;
    const std::size_t count = pmp::connected_components(mesh, piece);
    std::vector<double> volume(count, 0.0);
    std::vector<std::vector<HalfedgeMesh::Face_index>> faces(count);
    for (const auto face : mesh.faces()) {
        const auto h = mesh.halfedge(face);
        volume[piece[face]] += CGAL::determinant(mesh.point(mesh.source(h)) - CGAL::ORIGIN,
                                                 mesh.point(mesh.target(h)) - CGAL::ORIGIN,
                                                 mesh.point(mesh.target(mesh.next(h))) - CGAL::ORIGIN);
        faces[piece[face]].push_back(face);
    }
    for (std::size_t i = 0; i < count; ++i)
        if (volume[i] < 0) pmp::reverse_face_orientations(faces[i], mesh);
}

// With cavities as such where CGAL can tell; where triangles without area stand in its way, by volumes.
void turn_outside_out(HalfedgeMesh& mesh, Report& report) {
    try {
        if (pmp::is_outward_oriented(mesh) && pmp::does_bound_a_volume(mesh)) return;
        pmp::orient_to_bound_a_volume(mesh);
        report.say(true, "turned outside out");
    } catch (const CGAL::Failure_exception&) {
        turn_pieces(mesh);
        report.say(true, "turned outside out piece by piece");
    }
}

void repair(HalfedgeMesh& mesh, Report& report) {
    report.count(pmp::stitch_borders(mesh), "seam", "sewn together");
    const std::size_t faces = mesh.number_of_faces();
    pmp::remove_degenerate_faces(mesh);
    if (mesh.number_of_faces() < faces)
        report.count(faces - mesh.number_of_faces(), "triangle", "without area taken out");
    close_holes(mesh, report);
    if (!mesh.is_empty() && CGAL::is_closed(mesh)) turn_outside_out(mesh, report);
}

void subdivide(HalfedgeMesh& mesh, const Mesh& said, Report& report) {
    if (mesh.number_of_faces() > most_triangles >> (2 * said.subdivide))
        throw SceneError(said.said_at,
                         fmt::format("`subdivide {}` would make {} triangles; at most {} are allowed",
                                     said.subdivide, mesh.number_of_faces() << (2 * said.subdivide),
                                     most_triangles));
    const auto rounds = static_cast<unsigned>(said.subdivide);
    CGAL::Subdivision_method_3::Loop_subdivision(mesh, CGAL::parameters::number_of_iterations(rounds));
    report.done.push_back("subdivided " + plural(rounds, "time"));
}

struct FewEnough {
    std::size_t wanted;
    template <class Cost, class Profile>
    bool operator()(const Cost&, const Profile& profile, std::size_t, std::size_t) const {
        return profile.surface_mesh().number_of_faces() <= wanted;
    }
};

void simplify(HalfedgeMesh& mesh, const Mesh& said, Report& report) {
    const auto wanted = static_cast<std::size_t>(said.simplify);
    if (mesh.number_of_faces() <= wanted) return;
    // Quadrics [Garland and Heckbert 1997] weigh an edge in constant time; with CGAL's usual cost a fan of a
    // thousand slivers takes time by the cube of their number.
    const collapse::GarlandHeckbert_plane_policies<HalfedgeMesh, Kernel> quadrics(mesh);
    collapse::edge_collapse(mesh, FewEnough{wanted},
                            CGAL::parameters::filter(collapse::Bounded_normal_change_filter<>())
                                .get_cost(quadrics.get_cost())
                                .get_placement(quadrics.get_placement()));
    report.say(true, "simplified");
    report.say(mesh.number_of_faces() > wanted, "as far as it goes");
}

MeshData to_data(HalfedgeMesh& mesh, const Mesh& said) {
    mesh.collect_garbage();
    MeshData data;
    data.positions.reserve(mesh.number_of_vertices());
    for (const auto v : mesh.vertices()) {
        const Point& p = mesh.point(v);
        const Vec3f f(Vec3(p.x(), p.y(), p.z()));
        if (!std::isfinite(f.x) || !std::isfinite(f.y) || !std::isfinite(f.z))
            throw SceneError(said.said_at, "the mesh is too large to be worked on");
        data.positions.push_back(f);
    }
    data.triangles.reserve(mesh.number_of_faces());
    for (const auto face : mesh.faces()) {
        const auto h = mesh.halfedge(face);
        data.triangles.push_back(
            {mesh.source(h).idx(), mesh.target(h).idx(), mesh.target(mesh.next(h)).idx()});
    }
    return data;
}

} // namespace

MeshData work_on_mesh(const MeshData& data, const Mesh& said, std::vector<std::string>& notes) {
    Report report;
    try {
        Soup soup = to_soup(data);
        clean(soup, report);
        HalfedgeMesh mesh = connect(soup, report);
        if (said.repair) repair(mesh, report);
        if (said.subdivide > 0) subdivide(mesh, said, report);
        if (said.simplify > 0) simplify(mesh, said, report);
        report.say(!data.uvs.empty(), "its uvs were lost");
        MeshData out = to_data(mesh, said);
        std::string note = said.file.empty() ? "mesh" : std::filesystem::path(said.file).filename().string();
        for (std::size_t i = 0; i < report.done.size(); ++i) note += (i ? ", " : ": ") + report.done[i];
        if (report.done.empty()) note += ": nothing to mend";
        notes.push_back(fmt::format("{}; {} before, {} now", note, plural(data.triangles.size(), "triangle"),
                                    out.triangles.size()));
        return out;
    } catch (const CGAL::Failure_exception& failure) {
        throw SceneError(said.said_at, fmt::format("CGAL cannot work on this mesh ({}); render it as it is",
                                                   failure.expression()));
    }
}

} // namespace pnr
