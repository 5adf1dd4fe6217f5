// SPDX-License-Identifier: GPL-3.0-or-later
// `pnr stability`: stiff and extreme cases, each there because something could break, each held against a
// bound that theory or a reference of higher precision gives.
#pragma once

#include <string>
#include <vector>

namespace pnr {

struct StabilityCase {
    std::string group, name;
    std::string measured; // what the number is
    double bound = 0;     // largest value that is right
    double value = 0;     // not a number: never right
};
inline bool holds(const StabilityCase& c) { return c.value <= c.bound; }

using StabilityCases = std::vector<StabilityCase>;

StabilityCases path_cases();    // the strokes' paths along stiff fields
StabilityCases field_cases();   // orientation fields by radial basis functions
StabilityCases root_cases();    // polynomials with near-multiple roots
StabilityCases ray_cases();     // slivers, scales, coincident and grazing faces, refraction
StabilityCases photon_cases();  // photon maps without extent, powers from 1e-30 to 1e30, energy
StabilityCases picture_cases(); // whole scenes: scaled, moved, lit by next to nothing or far too much
StabilityCases sum_cases();     // weights at no distance, sums of many terms

} // namespace pnr
