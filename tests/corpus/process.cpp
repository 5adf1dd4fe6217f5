// SPDX-License-Identifier: GPL-3.0-or-later
#include "process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace pnr {

namespace {

// Between fork and exec: only calls that are safe there.
[[noreturn]] void become(char* const* argv, const char* folder, const char* log, int cpu_limit) {
    const int out = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (out < 0 || ::chdir(folder) != 0) ::_exit(126);
    ::dup2(out, 1);
    ::dup2(out, 2);
    const int in = ::open("/dev/null", O_RDONLY);
    ::dup2(in, 0);
    const rlimit limit{static_cast<rlim_t>(cpu_limit), static_cast<rlim_t>(cpu_limit) + 1};
    ::setrlimit(RLIMIT_CPU, &limit);
    ::execvp(argv[0], argv);
    ::_exit(127);
}

double seconds(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

} // namespace

Process run_process(const std::vector<std::string>& words, const std::filesystem::path& folder,
                    const std::filesystem::path& log, int cpu_limit) {
    std::vector<std::string> copies = words;
    std::vector<char*> argv;
    for (std::string& word : copies) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string where = folder.string(), into = log.string();
    const pid_t child = ::fork();
    if (child == 0) become(argv.data(), where.c_str(), into.c_str(), cpu_limit);
    Process result;
    if (child < 0) return result;
    const auto started = std::chrono::steady_clock::now();
    int status = 0;
    rusage usage{};
    for (pid_t got = 0; got == 0 || (got < 0 && errno == EINTR);) {
        got = ::wait4(child, &status, WNOHANG, &usage);
        if (got != 0) continue;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        if (std::chrono::steady_clock::now() - started > std::chrono::seconds(10 * cpu_limit)) {
            result.timed_out = true;
            ::kill(child, SIGKILL);
        }
    }
    result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    result.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.timed_out = result.timed_out || (WIFSIGNALED(status) && result.cpu_s >= cpu_limit);
    std::ifstream file(log, std::ios::binary);
    result.text = {std::istreambuf_iterator<char>(file), {}};
    return result;
}

} // namespace pnr
