// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_pnr.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <iterator>
#include <poll.h>
#include <stdexcept>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pnr {

namespace fs = std::filesystem;

namespace {

fs::path make_folder() {
    std::string pattern = (fs::temp_directory_path() / "pnr-test-XXXXXX").string();
    return ::mkdtemp(pattern.data());
}

} // namespace

TemporaryFolder::TemporaryFolder() : path_(make_folder()), cache_(make_folder()) {}
TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    fs::remove_all(cache_, ignored);
}
void TemporaryFolder::write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
}
std::string TemporaryFolder::read(const std::string& name) const {
    std::ifstream file(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}
std::vector<std::string> TemporaryFolder::names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(path_)) all.push_back(entry.path().filename().string());
    std::sort(all.begin(), all.end());
    return all;
}

namespace {

struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
        read = ends[0];
        write = ends[1];
    }
    ~Pipe() {
        close_end(read);
        close_end(write);
    }
    static void close_end(int& end) {
        if (end >= 0) ::close(end);
        end = -1;
    }
};

pid_t start(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
            const Environment& environment, Pipe& in, Pipe& out, Pipe& err) {
    std::vector<std::string> words{PNR_BINARY};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::setenv("XDG_CACHE_HOME", folder.cache().c_str(), 1); // never the user's own
    for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
    ::dup2(in.read, 0);
    ::dup2(out.write, 1);
    ::dup2(err.write, 2);
    if (::chdir(folder.path().c_str()) != 0) ::_exit(126);
    ::execv(argv[0], argv.data());
    ::_exit(127);
}

Ran run(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
        const Environment& environment, const std::string& input, int signal, const std::string& signal_at) {
    Pipe in, out, err;
    const pid_t child = start(folder, arguments, environment, in, out, err);
    Pipe::close_end(in.read);
    Pipe::close_end(out.write);
    Pipe::close_end(err.write);
    // Scenes in these tests are smaller than a pipe's buffer.
    std::signal(SIGPIPE, SIG_IGN);
    if (::write(in.write, input.data(), input.size()) < 0) throw std::runtime_error("write to the child");
    Pipe::close_end(in.write);
    Ran ran;
    bool sent = signal == 0;
    pollfd watched[2] = {{out.read, POLLIN, 0}, {err.read, POLLIN, 0}};
    std::string* texts[2] = {&ran.out, &ran.err};
    while (watched[0].fd >= 0 || watched[1].fd >= 0) {
        ::poll(watched, 2, -1);
        for (int i = 0; i < 2; ++i) {
            if (watched[i].revents == 0) continue;
            char buffer[65536];
            const ssize_t got = ::read(watched[i].fd, buffer, sizeof buffer);
            if (got > 0)
                texts[i]->append(buffer, static_cast<std::size_t>(got));
            else
                watched[i].fd = -1;
        }
        if (!sent && ran.err.find(signal_at) != std::string::npos) {
            ::kill(child, signal);
            sent = true;
        }
    }
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    ran.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    ran.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return ran;
}

} // namespace

Ran run_pnr(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
            const Environment& environment, const std::string& input) {
    return run(folder, arguments, environment, input, 0, "");
}
Ran run_pnr_and_signal(const TemporaryFolder& folder, const std::vector<std::string>& arguments, int signal,
                       const std::string& signal_at) {
    return run(folder, arguments, {}, "", signal, signal_at);
}

struct RunningPnr::Ends {
    Pipe in, out, err;
};

RunningPnr::RunningPnr(const TemporaryFolder& folder, const std::vector<std::string>& arguments)
    : ends_(std::make_unique<Ends>()) {
    child_ = start(folder, arguments, {}, ends_->in, ends_->out, ends_->err);
    Pipe::close_end(ends_->err.write);
}

RunningPnr::~RunningPnr() {
    if (child_ < 0) return;
    signal(SIGKILL);
    end();
}

bool RunningPnr::says(const std::string& text) {
    constexpr int longest_ms = 100'000; // on a machine that does much else
    for (;;) {
        const std::size_t at = err_.find(text, read_);
        if (at != std::string::npos) {
            read_ = at + text.size();
            return true;
        }
        pollfd watched{ends_->err.read, POLLIN, 0};
        if (::poll(&watched, 1, longest_ms) <= 0) return false;
        char buffer[4096];
        const ssize_t got = ::read(ends_->err.read, buffer, sizeof buffer);
        if (got <= 0) return false;
        err_.append(buffer, static_cast<std::size_t>(got));
    }
}

void RunningPnr::signal(int signal) const { ::kill(child_, signal); }

int RunningPnr::end() {
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string box_scene(const std::string& more) {
    return R"(camera { location <0, 1, -2.6> look_at <0, 0.9, 0> right x angle 50 }
light_source { <0, 1.999, 0>, rgb 1 emitter { hemisphere 0.3, -y } power 60 }
#declare Wall = finish { ambient 0 diffuse 0.7 };
plane { y, 0 pigment { rgb 0.9 } finish { Wall } }
plane { -y, -2 pigment { rgb 0.9 } finish { Wall } }
plane { x, -1 pigment { rgb <0.9, 0.2, 0.2> } finish { Wall } }
plane { -x, -1 pigment { rgb <0.2, 0.9, 0.2> } finish { Wall } }
plane { -z, -1 pigment { rgb 0.9 } finish { Wall } }
plane { z, -3 pigment { rgb 0.9 } finish { Wall } }
sphere { <-0.35, 0.5, 0.1>, 0.5 pigment { rgb <0.9, 0.7, 0.4> } finish { Wall }
  npr { interpolation { radius 20 } seeds { seed { <-0.35, 1, 0.1>, x } seed { <-0.35, 0.5, -0.4>, y } seed { <-0.85, 0.5, 0.1>, y }
                seed { <0.15, 0.5, 0.1>, y } } } }
sphere { <0.5, 0.35, -0.3>, 0.35 pigment { rgb 0.9 } finish { Wall } }
)" + more;
}

} // namespace pnr
