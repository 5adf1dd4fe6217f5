// SPDX-License-Identifier: GPL-3.0-or-later
namespace pnr {
const char* version() { return PNR_VERSION; }
}
