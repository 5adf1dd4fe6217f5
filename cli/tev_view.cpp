// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/tev_view.h"

#include "cli/parts.h"
#include "cli/report.h"

#include <fmt/format.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace pnr {

namespace {

static_assert(std::endian::native == std::endian::little, "packets are written as they lie in memory");

enum class Kind : unsigned char { close_image = 2, create_image = 4, update_image = 6 };

class PacketWriter {
public:
    explicit PacketWriter(Kind kind) {
        add(std::uint32_t{0}); // the length, once it is known
        add(kind);
    }
    template <class T>
    void add(T value) {
        const auto* from = reinterpret_cast<const unsigned char*>(&value);
        bytes_.insert(bytes_.end(), from, from + sizeof(T));
    }
    void add_text(const std::string& text) {
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        bytes_.push_back(0);
    }
    void add_floats(const std::vector<float>& values) {
        const auto* from = reinterpret_cast<const unsigned char*>(values.data());
        bytes_.insert(bytes_.end(), from, from + values.size() * sizeof(float));
    }
    TevPacket done() {
        const auto length = static_cast<std::uint32_t>(bytes_.size());
        std::memcpy(bytes_.data(), &length, sizeof length);
        return {std::move(bytes_)};
    }

private:
    std::vector<unsigned char> bytes_;
};

// A viewer that does not take what is sent must not hold a rendering up for long.
void limit_waiting(int socket) {
    const timeval longest{3, 0};
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &longest,
                 sizeof longest); // connecting waits no longer either
}

// -1 and errno if nobody answers.
int connect_to(const std::string& host, const std::string& port) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    if (::getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) {
        errno = EHOSTUNREACH;
        return -1;
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
    for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
        const int socket = ::socket(each->ai_family, each->ai_socktype | SOCK_CLOEXEC, each->ai_protocol);
        if (socket < 0) continue;
        limit_waiting(socket);
        if (::connect(socket, each->ai_addr, each->ai_addrlen) == 0) return socket;
        const int why = errno;
        ::close(socket);
        errno = why;
    }
    return -1;
}

// The layers' channels are named NAME.CHANNEL; those of the picture itself have no name before them.
struct LayerOf {
    const char* name;
    RenderedPart part; // with which it is finished
};
constexpr LayerOf layers[] = {{"", RenderedPart::light},
                              {"photoreal", RenderedPart::light},
                              {"N", RenderedPart::seen},
                              {"P", RenderedPart::seen},
                              {"Z", RenderedPart::seen},
                              {"id", RenderedPart::seen},
                              {"npr.mask", RenderedPart::seen},
                              {"sparse", RenderedPart::paint},
                              {"informative", RenderedPart::paint},
                              {"partial", RenderedPart::paint}};

// Colour and alpha of what there is of these layers, added up: pixels whose light is not found yet have their
// paint alone.
std::vector<float> sum_of(std::initializer_list<const Layer*> all, const PixelRect& where) {
    std::vector<float> data;
    for (int y = where.y0; y < where.y1; ++y)
        for (int x = where.x0; x < where.x1; ++x) {
            Color color(0);
            float alpha = 0;
            for (const Layer* layer : all) {
                if (layer->color.empty()) continue;
                color += layer->color.at(x, y);
                alpha += layer->alpha.at(x, y);
            }
            data.insert(data.end(), {color.x, color.y, color.z, std::min(alpha, 1.0f)});
        }
    return data;
}

std::vector<std::string> channels_of(const std::string& layer) {
    if (layer.empty()) return {"R", "G", "B", "A"};
    if (layer == "N" || layer == "P") return {layer + ".X", layer + ".Y", layer + ".Z"};
    if (layer == "Z" || layer == "npr.mask") return {layer};
    if (layer == "id") return {"id.object", "id.via"};
    if (layer == "sparse")
        return {"sparse.R", "sparse.G",         "sparse.B",      "sparse.dir.X", "sparse.dir.Y",
                "sparse.Z", "sparse.id.object", "sparse.id.via", "sparse.source"};
    if (layer == "informative")
        return {"informative.R",      "informative.G",        "informative.B",
                "informative.dir.X",  "informative.dir.Y",    "informative.id.object",
                "informative.id.via", "informative.coverage", "informative.kind"};
    return {layer + ".R", layer + ".G", layer + ".B", layer + ".A"};
}

std::vector<float> data_of(const Rendering& r, const std::string& layer, const PixelRect& where) {
    if (layer.empty()) return sum_of({&r.paint.layer, &r.rendered.layer}, where);
    if (layer == "photoreal") return sum_of({&r.rendered.layer}, where);
    if (layer == "partial") return sum_of({&r.paint.layer}, where);
    return cut(aov_part(r, layer), r.settings.render.width, where).data;
}

} // namespace

TevPacket tev_close(const std::string& image) {
    PacketWriter packet(Kind::close_image);
    packet.add_text(image);
    return packet.done();
}

TevPacket tev_create(const std::string& image, int width, int height,
                     const std::vector<std::string>& channels) {
    PacketWriter packet(Kind::create_image);
    packet.add(true);
    packet.add_text(image);
    packet.add(std::int32_t{width});
    packet.add(std::int32_t{height});
    packet.add(static_cast<std::int32_t>(channels.size()));
    for (const std::string& channel : channels) packet.add_text(channel);
    return packet.done();
}

TevPacket tev_update(const std::string& image, const std::vector<std::string>& channels,
                     const PixelRect& where, const std::vector<float>& data) {
    PacketWriter packet(Kind::update_image);
    packet.add(false);
    packet.add_text(image);
    packet.add(static_cast<std::int32_t>(channels.size()));
    for (const std::string& channel : channels) packet.add_text(channel);
    for (const int number : {where.x0, where.y0, where.x1 - where.x0, where.y1 - where.y0})
        packet.add(std::int32_t{number});
    for (std::size_t i = 0; i < channels.size(); ++i) packet.add(static_cast<std::int64_t>(i));
    for (std::size_t i = 0; i < channels.size(); ++i) packet.add(static_cast<std::int64_t>(channels.size()));
    packet.add_floats(data);
    return packet.done();
}

TevView::TevView(const std::string& place, std::string image) : place_(place), image_(std::move(image)) {
    const std::size_t colon = place.rfind(':');
    socket_ = connect_to(place.substr(0, colon), place.substr(colon + 1));
    if (socket_ < 0)
        print_warning(fmt::format("--tev: no viewer answers at {} ({}); the picture is made without it",
                                  place, std::strerror(errno)));
}

TevView::~TevView() {
    if (socket_ >= 0) ::close(socket_);
}

void TevView::send(const TevPacket& packet) {
    std::size_t done = 0;
    while (socket_ >= 0 && done < packet.bytes.size()) {
        const ssize_t sent =
            ::send(socket_, packet.bytes.data() + done, packet.bytes.size() - done, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) {
            print_warning(
                fmt::format("--tev: the viewer at {} went away ({}); the picture is made without it", place_,
                            std::strerror(errno)));
            ::close(socket_);
            socket_ = -1;
            return;
        }
        done += static_cast<std::size_t>(sent);
    }
}

void TevView::open_image(int width, int height) {
    if (width == width_ && height == height_) return;
    if (width_ > 0) send(tev_close(image_));
    std::vector<std::string> channels;
    for (const LayerOf& layer : layers)
        for (std::string& channel : channels_of(layer.name)) channels.push_back(std::move(channel));
    send(tev_create(image_, width, height, channels));
    width_ = width;
    height_ = height;
}

// In bands: a packet's length has 32 bits.
void TevView::send_part(const Rendering& r, const std::string& layer, const PixelRect& where) {
    const std::vector<std::string> channels = channels_of(layer);
    const std::vector<float> all = data_of(r, layer, where);
    constexpr int rows = 256;
    const std::size_t row = static_cast<std::size_t>(where.x1 - where.x0) * channels.size();
    for (int y = where.y0; y < where.y1 && socket_ >= 0; y += rows) {
        const PixelRect band{where.x0, y, where.x1, std::min(y + rows, where.y1)};
        const auto at = [&](int line) {
            return all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(line - where.y0) * row);
        };
        send(tev_update(image_, channels, band, {at(band.y0), at(band.y1)}));
    }
}

void TevView::show(const Rendering& r, RenderedPart part, const PixelRect& where) {
    if (socket_ < 0) return;
    open_image(r.settings.render.width, r.settings.render.height);
    for (const LayerOf& layer : layers)
        if (layer.part == part) send_part(r, layer.name, where);
    if (part == RenderedPart::paint) send_part(r, "", where);
}

std::function<void(const Rendering&, RenderedPart, const PixelRect&)>
viewer_of(std::optional<TevView>& viewer) {
    if (!viewer) return {};
    return [&viewer](const Rendering& r, RenderedPart part, const PixelRect& where) {
        viewer->show(r, part, where);
    };
}

} // namespace pnr
