// SPDX-License-Identifier: GPL-3.0-or-later
// Progressive rendering on the command line: passes until the time is up, the error is reached or there are enough.
#pragma once

#include "cli/pipeline.h"

namespace pnr {

// Needs r.photons without its field and r.gbuffer; fills r.paint, r.rendered (means over the passes), r.progressive,
// r.error and r.stopped. The first pass is always finished, unless a signal comes; a pass that the clock ends is
// dropped, so that `--passes N` gives the same bits as the run that got so far.
void refine(Rendering& r, const Wishes& wishes, Passes& passes);

} // namespace pnr
