// SPDX-License-Identifier: GPL-3.0-or-later
// SIGINT and SIGTERM. While nothing worth saving exists they end the process at once, with 130 or 143; from
// `stop_gently` on they raise a flag that the passes ask for, and only a second signal ends the process at
// once. SIGUSR1 asks a progressive run to write the picture as it stands and to go on.
#pragma once

namespace pnr {

void install_signal_handlers();
void stop_gently();
int stop_signal(); // the signal that asked to stop; 0: none did
bool take_picture_request(); // whether SIGUSR1 came since the last call

} // namespace pnr
