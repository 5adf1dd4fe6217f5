// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/atomic_file.h"

#include "core/types.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace pnr {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) {
    const fs::path folder = file.parent_path();
    std::error_code ignored;
    std::string why = std::strerror(error);
    if (error == ENOENT && !folder.empty() && !fs::exists(folder, ignored))
        why = "there is no folder `" + folder.string() + "`";
    throw FileError("cannot write `" + file.string() + "`: " + why);
}

// 0 or the error number.
int write_all(int descriptor, std::span<const unsigned char> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return 0;
}

void write_directly(const fs::path& file, std::span<const unsigned char> bytes) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail(file, errno);
    const int error = write_all(descriptor, bytes);
    ::close(descriptor);
    if (error != 0) fail(file, error);
}

} // namespace

void write_file_atomically(const fs::path& file, std::span<const unsigned char> bytes) {
    std::error_code ignored;
    const fs::path target = fs::is_symlink(file, ignored) ? fs::weakly_canonical(file, ignored) : file;
    const fs::file_status status = fs::status(target, ignored);
    if (fs::is_directory(status)) fail(file, EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_directly(target, bytes);
    // Renaming would replace a file that its owner has protected.
    if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0) fail(file, errno);

    std::string name = "."; // hidden, and of this process alone
    name += target.filename().string();
    name += ".pnr-" + std::to_string(::getpid());
    const fs::path temporary = target.parent_path() / name;
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor < 0) fail(file, errno);
    int error = write_all(descriptor, bytes);
    if (::close(descriptor) != 0 && error == 0) error = errno;
    if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0) error = errno;
    if (error == 0) return;
    ::unlink(temporary.c_str());
    fail(file, error);
}

void write_file_atomically(const fs::path& file, std::string_view text) {
    write_file_atomically(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

} // namespace pnr
