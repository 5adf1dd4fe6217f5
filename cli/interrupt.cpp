// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/interrupt.h"

#include <csignal>
#include <unistd.h>

namespace pnr {

namespace {

// A signal handler can reach nothing but such variables.
volatile std::sig_atomic_t caught = 0;
volatile std::sig_atomic_t gentle = 0;
volatile std::sig_atomic_t picture_wanted = 0;

void on_signal(int signal) {
    if (gentle == 0 || caught != 0) _exit(128 + signal);
    caught = signal;
}

void on_request(int) { picture_wanted = 1; }

} // namespace

void install_signal_handlers() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    action.sa_handler = on_request;
    sigaction(SIGUSR1, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN); // a reader that goes away is a failed write, not a death
}

void stop_gently() { gentle = 1; }
int stop_signal() { return caught; }

bool take_picture_request() {
    const bool wanted = picture_wanted != 0;
    picture_wanted = 0;
    return wanted;
}

} // namespace pnr
