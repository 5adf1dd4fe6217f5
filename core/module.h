// SPDX-License-Identifier: GPL-3.0-or-later
// Libraries of ours that are opened on demand, because what they link is heavy and most runs do without.
#pragma once

namespace pnr {

// A module's library exports a function `extern "C" const X* symbol()`, whose X begins with an int: its
// version.
struct ModuleName {
    const char* what;        // "image"
    const char* links;       // the heavy library behind it, as left_out_parts names it
    const char* library;     // "libpnr_image.so"
    const char* environment; // a variable that names the library's file instead
    const char* symbol;
    int version;
};

// What the module's function returns. Its library lies where the environment says or, if that says nothing,
// beside the program in a build folder or an installation, or where the program's linker looks; it is never closed. Throws FileError if it is not
// there or of another build.
const void* open_module(const ModuleName& name);

// The libraries that this build was made without (cmake -DPNR_WITH_...=OFF), "FreeType, OpenImageIO"; "" if it has all.
const char* left_out_parts();

} // namespace pnr
