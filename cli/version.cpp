// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/options.h"

namespace pnr {

const char* version() { return PNR_VERSION; }

} // namespace pnr
