// SPDX-License-Identifier: GPL-3.0-or-later
// What a viewer gets, read back by the protocol's layout; the viewer here is a small server.
#include "cli/tev_view.h"

#include "core/image_io.h"
#include "run_pnr.h"

#include <arpa/inet.h>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace pnr {
namespace {

// Takes a packet apart, field by field; reading behind its end is a failure.
struct PacketReader {
    const std::vector<unsigned char>& bytes;
    std::size_t at = 0;

    template <class T>
    T take() {
        T value{};
        if (at + sizeof(T) > bytes.size()) throw std::runtime_error("the packet is too short");
        std::memcpy(&value, bytes.data() + at, sizeof(T));
        at += sizeof(T);
        return value;
    }
    std::string text() {
        std::string value;
        while (const char c = take<char>()) value += c;
        return value;
    }
    bool done() const { return at == bytes.size(); }
};

TEST(TevPacket, HasTheDocumentedLayout) {
    const TevPacket create = tev_create("a", 5, 4, {"R", "Z"});
    const unsigned char wanted[] = {24, 0, 0, 0, 4, 1, 'a', 0, 5,   0, 0,   0,
                                    4,  0, 0, 0, 2, 0, 0,   0, 'R', 0, 'Z', 0};
    ASSERT_EQ(create.bytes.size(), sizeof wanted);
    EXPECT_EQ(create.bytes[0], sizeof wanted);
    EXPECT_TRUE(std::equal(create.bytes.begin() + 1, create.bytes.end(), std::begin(wanted) + 1));

    const TevPacket update = tev_update("a", {"R", "Z"}, {1, 2, 3, 3}, {0.5f, 7, 0.25f, 8});
    PacketReader in{update.bytes};
    EXPECT_EQ(in.take<std::uint32_t>(), update.bytes.size());
    EXPECT_EQ(in.take<char>(), 6);
    EXPECT_EQ(in.take<char>(), 0);
    EXPECT_EQ(in.text(), "a");
    EXPECT_EQ(in.take<std::int32_t>(), 2);
    EXPECT_EQ(in.text(), "R");
    EXPECT_EQ(in.text(), "Z");
    for (const int number : {1, 2, 2, 1}) EXPECT_EQ(in.take<std::int32_t>(), number); // x y width height
    for (const int offset : {0, 1}) EXPECT_EQ(in.take<std::int64_t>(), offset);
    for (const int stride : {2, 2}) EXPECT_EQ(in.take<std::int64_t>(), stride);
    for (const float value : {0.5f, 7.0f, 0.25f, 8.0f}) EXPECT_EQ(in.take<float>(), value);
    EXPECT_TRUE(in.done());

    const TevPacket close = tev_close("a");
    EXPECT_EQ(close.bytes, (std::vector<unsigned char>{7, 0, 0, 0, 2, 'a', 0}));
}

// Listens on a port of its own and keeps what comes; with `most` it hangs up after so many bytes.
class Viewer {
public:
    explicit Viewer(std::size_t most = ~std::size_t{0}) : most_(most) {
        listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listener_, 1) != 0)
            throw std::runtime_error("cannot listen");
        socklen_t size = sizeof address;
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this] { take_all(); });
    }
    ~Viewer() {
        if (thread_.joinable()) thread_.join();
        ::close(listener_);
    }
    std::string place() const { return "127.0.0.1:" + std::to_string(port_); }
    const std::vector<unsigned char>& bytes() {
        thread_.join();
        return bytes_;
    }

private:
    void take_all() {
        pollfd waited{listener_, POLLIN, 0};
        if (::poll(&waited, 1, 60'000) <= 0) return;
        const int connection = ::accept(listener_, nullptr, nullptr);
        unsigned char buffer[65536];
        ssize_t got = 0;
        while (bytes_.size() < most_ && (got = ::read(connection, buffer, sizeof buffer)) > 0)
            bytes_.insert(bytes_.end(), buffer, buffer + got);
        ::close(connection);
    }
    std::size_t most_;
    int listener_ = -1;
    int port_ = 0;
    std::vector<unsigned char> bytes_;
    std::thread thread_;
};

// The image as a viewer has it after all packets.
struct ViewerImage {
    std::string name;
    int width = 0, height = 0, creations = 0, updates = 0;
    std::map<std::string, std::vector<float>> channels;

    void take(const std::vector<unsigned char>& packet) {
        PacketReader in{packet};
        in.take<std::uint32_t>();
        const char kind = in.take<char>();
        if (kind == 4) create(in);
        if (kind == 6) update(in);
        EXPECT_TRUE(kind == 4 || kind == 6) << int{kind};
        EXPECT_TRUE(in.done());
    }

private:
    void create(PacketReader& in) {
        ++creations;
        in.take<char>();
        name = in.text();
        width = in.take<std::int32_t>();
        height = in.take<std::int32_t>();
        for (int n = in.take<std::int32_t>(); n > 0; --n)
            channels[in.text()].assign(static_cast<std::size_t>(width * height), 0.0f);
    }
    void update(PacketReader& in) {
        ++updates;
        in.take<char>();
        EXPECT_EQ(in.text(), name);
        std::vector<std::string> names(static_cast<std::size_t>(in.take<std::int32_t>()));
        for (std::string& each : names) each = in.text();
        const int x = in.take<std::int32_t>(), y = in.take<std::int32_t>(), w = in.take<std::int32_t>(),
                  h = in.take<std::int32_t>();
        std::vector<std::int64_t> offsets(names.size()), strides(names.size());
        for (auto& offset : offsets) offset = in.take<std::int64_t>();
        for (auto& stride : strides) stride = in.take<std::int64_t>();
        std::vector<float> data(names.size() * static_cast<std::size_t>(w * h));
        for (float& value : data) value = in.take<float>();
        for (std::size_t c = 0; c < names.size(); ++c) {
            ASSERT_TRUE(channels.contains(names[c])) << names[c];
            for (int i = 0; i < w * h; ++i)
                channels[names[c]][static_cast<std::size_t>((y + i / w) * width + x + i % w)] =
                    data[static_cast<std::size_t>(offsets[c] + i * strides[c])];
        }
    }
};

ViewerImage image_of(const std::vector<unsigned char>& bytes) {
    ViewerImage image;
    for (std::size_t at = 0; at + 4 <= bytes.size();) {
        std::uint32_t length = 0;
        std::memcpy(&length, bytes.data() + at, 4);
        if (length < 5 || at + length > bytes.size()) throw std::runtime_error("a packet is cut short");
        image.take({bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    bytes.begin() + static_cast<std::ptrdiff_t>(at + length)});
        at += length;
    }
    return image;
}

using Words = std::vector<std::string>;
const Words words{"render", "a.pnr", "-W", "48", "-H", "70", "--progress", "off", "--no-cache"};

Words with(Words more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
}

TEST(Tev, ShowsThePictureAndEveryMap) {
    const TemporaryFolder folder;
    folder.write("a.pnr", box_scene("global_settings { photons { count 4000 } }\n"));
    Viewer viewer;
    const Ran ran = run_pnr(
        folder, with({"-o", "seen.png", "-o", "seen.exr", "--maps", "maps", "--tev", viewer.place()}));
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("warning"), std::string::npos) << ran.err;
    const ViewerImage image = image_of(viewer.bytes());
    EXPECT_EQ(image.name, "pnr: seen.png");
    EXPECT_EQ(image.creations, 1);
    EXPECT_EQ(image.width, 48);
    EXPECT_EQ(image.height, 70);
    EXPECT_GT(image.updates, 10); // the light came in bands
    const auto expect_same = [&](const std::string& file, const std::string& channel,
                                 const std::string& shown) {
        const ImagePart part = read_exr(folder / file).parts.at(0);
        const auto c = static_cast<std::size_t>(
            std::find(part.channel_names.begin(), part.channel_names.end(), channel) -
            part.channel_names.begin());
        ASSERT_LT(c, part.channel_names.size()) << channel;
        ASSERT_TRUE(image.channels.contains(shown)) << shown;
        for (std::size_t i = 0; i < 48 * 70; ++i)
            ASSERT_EQ(image.channels.at(shown)[i], part.data[i * part.channel_names.size() + c])
                << file << " " << channel << " " << i;
    };
    expect_same("maps/gbuffer.exr", "N.X", "N.X");
    expect_same("maps/gbuffer.exr", "P.Y", "P.Y");
    expect_same("maps/gbuffer.exr", "id.object", "id.object");
    expect_same("maps/sparse.exr", "R", "sparse.R");
    expect_same("maps/sparse.exr", "dir.X", "sparse.dir.X");
    expect_same("maps/informative.exr", "kind", "informative.kind");
    expect_same("maps/partial.exr", "G", "partial.G");
    expect_same("maps/photoreal.exr", "B", "photoreal.B");
    const ImagePart beauty = read_exr(folder / "seen.exr").parts.at(0);
    for (std::size_t i = 0; i < 48 * 70; ++i) // the file has half precision
        ASSERT_NEAR(image.channels.at("R")[i], beauty.data[i * 4], 1e-3 * (1 + std::abs(beauty.data[i * 4])));
}

TEST(Tev, ChangesNoBit) {
    const TemporaryFolder folder;
    folder.write("a.pnr", box_scene("global_settings { photons { count 4000 } }\n"));
    ASSERT_EQ(run_pnr(folder, with({"-o", "alone.png"})).code, 0);
    Viewer viewer;
    ASSERT_EQ(run_pnr(folder, with({"-o", "seen.png", "--tev", viewer.place()})).code, 0);
    EXPECT_TRUE(folder.read("seen.png") == folder.read("alone.png"));
}

TEST(Tev, ALostViewerIsAWarning) {
    const TemporaryFolder folder;
    folder.write("a.pnr", box_scene("global_settings { photons { count 4000 } }\n"));
    std::string nobody;
    {
        Viewer gone(0);
        nobody = gone.place();
        const Ran ran = run_pnr(folder, with({"-o", "lost.png", "--tev", nobody})); // hangs up at once
        EXPECT_EQ(ran.code, 0) << ran.err;
        EXPECT_NE(folder.read("lost.png"), "");
    }
    const Ran ran = run_pnr(folder, with({"-o", "none.png", "--tev", nobody}));
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_NE(ran.err.find("warning: --tev: no viewer answers at " + nobody), std::string::npos) << ran.err;
    EXPECT_EQ(folder.read("lost.png"), folder.read("none.png"));
    EXPECT_EQ(run_pnr(folder, with({"-o", "a.png", "--tev", "nonsense"})).code, 2);
}

} // namespace
} // namespace pnr
