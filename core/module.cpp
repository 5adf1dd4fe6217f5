// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/module.h"

#include "core/types.h"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <vector>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// Where the module may lie, first choice first.
std::vector<fs::path> module_places(const ModuleName& name) {
    if (const char* named = std::getenv(name.environment)) return {named};
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    const fs::path root = program.parent_path().parent_path();
    // Last where the linker looks for libraries: a program that uses ours may lie anywhere.
    if (error) return {name.library};
    return {root / "lib" / name.library, root / "lib" / "pnr" / name.library, name.library};
}

} // namespace

const char* left_out_parts() { return PNR_LEFT_OUT; }

const void* open_module(const ModuleName& name) {
    if (std::string(left_out_parts()).find(name.links) != std::string::npos)
        throw FileError(std::string("this pnr was built without ") + name.links);
    std::string reasons;
    for (const fs::path& place : module_places(name)) {
        void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (library == nullptr) {
            reasons += std::string("\n  ") + ::dlerror();
            continue;
        }
        const auto get = reinterpret_cast<const int* (*)()>(::dlsym(library, name.symbol));
        if (get != nullptr && *get() == name.version) return get();
        reasons += "\n  " + place.string() + ": of another version of pnr";
    }
    throw FileError(std::string("cannot open the ") + name.what + " module (" + name.environment +
                    " can name it):" + reasons);
}

} // namespace pnr
