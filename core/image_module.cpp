// SPDX-License-Identifier: GPL-3.0-or-later
// The image module: the only code that knows OpenImageIO. It encodes into memory and decodes from files; no
// exception leaves it.
#include "core/image_module.h"

#include "core/palette_picture.h"

#include <OpenImageIO/imageio.h>

#include <cerrno>
#include <exception>
#include <sys/mman.h>
#include <system_error>
#include <unistd.h>

namespace pnr {

namespace {

// Rec.709 primaries and the D65 white, as EXR's chromaticities: red, green, blue, white [ITU-R BT.709].
constexpr float rec709_chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

// A broken or hostile header must not exhaust the machine.
constexpr std::uint64_t largest_picture = std::uint64_t{1} << 29;

bool has_color(const std::vector<std::string>& channels) {
    for (const std::string& name : channels)
        if (name == "R" || name.ends_with(".R")) return true;
    return false;
}

int index_of(const std::vector<std::string>& names, const std::string& wanted) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == wanted) return static_cast<int>(i);
    return -1;
}

void add_metadata(OIIO::ImageSpec& spec, const Metadata& metadata) {
    for (const auto& [key, value] : metadata) {
        if (const auto* number = std::get_if<float>(&value))
            spec.attribute(key, *number);
        else
            spec.attribute(key, std::get<std::string>(value));
    }
}

OIIO::ImageSpec exr_spec(const ImageFile& image, const ImagePart& part, const PixelRect& window) {
    OIIO::ImageSpec spec(window.x1 - window.x0, window.y1 - window.y0,
                         static_cast<int>(part.channel_names.size()),
                         part.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    spec.x = window.x0;
    spec.y = window.y0;
    spec.full_width = image.width;
    spec.full_height = image.height;
    spec.channelnames = part.channel_names;
    spec.alpha_channel = index_of(part.channel_names, "A");
    spec.z_channel = index_of(part.channel_names, "Z");
    spec.attribute("compression", "zip");
    if (!part.name.empty()) spec.attribute("oiio:subimagename", part.name);
    if (has_color(part.channel_names)) {
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), rec709_chromaticities);
        spec.attribute("oiio:ColorSpace", "Linear");
    }
    add_metadata(spec, image.metadata);
    return spec;
}

std::string reason(const OIIO::ImageOutput& output) {
    const std::string text = output.geterror();
    return text.empty() ? "the image library gave no reason" : text;
}

// A file without a place on disk: OpenImageIO 2.4 writes multi-part EXR to a path alone, not to memory.
class MemoryFile {
public:
    MemoryFile() : descriptor_(::memfd_create("pnr-exr", MFD_CLOEXEC)) {
        if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
    std::vector<unsigned char> bytes() const {
        std::vector<unsigned char> all(static_cast<std::size_t>(::lseek(descriptor_, 0, SEEK_END)));
        std::size_t done = 0;
        while (done < all.size()) {
            const ssize_t got =
                ::pread(descriptor_, all.data() + done, all.size() - done, static_cast<off_t>(done));
            if (got <= 0)
                throw std::system_error(errno, std::generic_category(), "reading back the encoded picture");
            done += static_cast<std::size_t>(got);
        }
        return all;
    }

private:
    int descriptor_;
};

std::string encode_exr(const ImageFile& image, std::vector<unsigned char>& file) {
    const PixelRect window =
        image.data_window.x1 == 0 ? PixelRect{0, 0, image.width, image.height} : image.data_window;
    std::vector<OIIO::ImageSpec> specs;
    for (const ImagePart& part : image.parts) specs.push_back(exr_spec(image, part, window));
    const MemoryFile memory;
    const std::string path = memory.path();
    const auto output = OIIO::ImageOutput::create("exr");
    if (!output) return OIIO::geterror();
    const bool opened = specs.size() == 1 ? output->open(path, specs[0])
                                          : output->open(path, static_cast<int>(specs.size()), specs.data());
    if (!opened) return reason(*output);
    for (std::size_t i = 0; i < specs.size(); ++i) {
        if (i > 0 && !output->open(path, specs[i], OIIO::ImageOutput::AppendSubimage)) return reason(*output);
        if (!output->write_image(OIIO::TypeDesc::FLOAT, image.parts[i].data.data())) return reason(*output);
    }
    if (!output->close()) return reason(*output);
    file = memory.bytes();
    return "";
}

std::string decode(const std::string& path, DecodedPicture& picture) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(path, &config);
    if (!input) return OIIO::geterror();
    const OIIO::ImageSpec first = input->spec();
    picture.is_integer = !first.format.is_floating_point();
    picture.bits = static_cast<int>(8 * first.format.size());
    if (first.image_pixels() > largest_picture) return "the picture has more than 2^29 pixels";
    ImageFile& image = picture.image;
    image.width = first.full_width;
    image.height = first.full_height;
    image.data_window = {first.x, first.y, first.x + first.width, first.y + first.height};
    for (const OIIO::ParamValue& attribute : first.extra_attribs) {
        if (attribute.type() == OIIO::TypeDesc::FLOAT)
            image.metadata.emplace_back(attribute.name().string(), attribute.get_float());
        else
            image.metadata.emplace_back(attribute.name().string(), attribute.get_string());
    }
    for (int part = 0; input->seek_subimage(part, 0); ++part) {
        const OIIO::ImageSpec spec = input->spec();
        if (spec.width != first.width || spec.height != first.height) break; // an animation or a set of sizes
        ImagePart read;
        read.name = spec.get_string_attribute("oiio:subimagename");
        read.channel_names = spec.channelnames;
        read.half = spec.format == OIIO::TypeDesc::HALF;
        read.data.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        if (!input->read_image(part, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, read.data.data()))
            return input->geterror();
        image.parts.push_back(std::move(read));
    }
    return "";
}

std::string decode_numbers(const std::string& path, Image<std::uint8_t>& numbers) {
    auto read = read_palette_numbers(path);
    if (!read) return "the picture has no palette";
    numbers = std::move(*read);
    return "";
}

template <auto work, class... Arguments>
std::string guarded(Arguments... arguments) {
    try {
        return work(arguments...);
    } catch (const std::exception& error) {
        return error.what();
    }
}

constexpr ImageModule module_table{
    image_module_version,
    guarded<encode_exr, const ImageFile&, std::vector<unsigned char>&>,
    guarded<decode, const std::string&, DecodedPicture&>,
    guarded<decode_numbers, const std::string&, Image<std::uint8_t>&>,
};

} // namespace

} // namespace pnr

extern "C" __attribute__((visibility("default"))) const pnr::ImageModule* pnr_image_module() {
    return &pnr::module_table;
}
