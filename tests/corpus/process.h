// SPDX-License-Identifier: GPL-3.0-or-later
// Another program, run with limits.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace pnr {

struct Process {
    int code = -1; // exit code; 128 + n if signal n ended it
    bool timed_out = false;
    double cpu_s = 0, wall_s = 0;
    double peak_rss_mb = 0;
    std::string text; // its standard output and error
};

// Runs words[0] (searched in PATH) in `folder`, with both outputs into `log`. It is ended after `cpu_limit`
// seconds of CPU time, or ten times that by the clock.
Process run_process(const std::vector<std::string>& words, const std::filesystem::path& folder,
                    const std::filesystem::path& log, int cpu_limit);

} // namespace pnr
