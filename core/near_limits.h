// SPDX-License-Identifier: GPL-3.0-or-later
// Where a world comes near what numbers can tell apart, said before it is rendered.
#pragma once

#include "core/settings.h"
#include "core/world.h"

#include <string>
#include <vector>

namespace pnr {

// One line each, with the place in the scene's text where there is one; of each kind the three worst:
// - a gather radius that is said and near the distance of the floats that photons' places are kept in;
// - objects that photons or paint lie on, so small and far from the scene's middle that these floats blur
// them;
// - seeds of an object that are so near to one another that their directions cannot both be met;
// - lights that get so few of the photons, because others are so much stronger, that their light will be
// spotty. `photons`: whether photons are traced at all.
std::vector<std::string> near_limits(const World& world, const Settings& settings, bool photons);

} // namespace pnr
