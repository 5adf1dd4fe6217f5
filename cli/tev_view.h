// SPDX-License-Identifier: GPL-3.0-or-later
// A picture in the making, shown by the viewer tev (https://github.com/Tom94/tev) over its documented TCP
// protocol: the picture and every map as layers of one image, sent as passes and bands of the picture are
// finished. A viewer that is not there, or goes away, is a warning and no error.
//
// A packet is its length in bytes (32 bits, itself included), a byte of its kind, and the kind's fields,
// little-endian; texts end in a zero byte, a truth is a byte. Kinds that we send: 2 close image (name), 4
// create image (grab focus, name, width, height, number of channels, their names), 6 update image (grab
// focus, name, number of channels, their names, x, y, width, height, each channel's offset and stride in
// floats as 64 bits, the floats).
#pragma once

#include "cli/pipeline.h"

#include <cstdint>
#include <string>
#include <vector>

namespace pnr {

inline constexpr const char* tev_usual_place = "127.0.0.1:14158";

struct TevPacket {
    std::vector<unsigned char> bytes;
};
TevPacket tev_close(const std::string& image);
TevPacket tev_create(const std::string& image, int width, int height,
                     const std::vector<std::string>& channels);
// `data`: the rectangle's pixels row by row, the channels interleaved.
TevPacket tev_update(const std::string& image, const std::vector<std::string>& channels,
                     const PixelRect& where, const std::vector<float>& data);

class TevView {
public:
    // `place`: HOST:PORT. Warns if nobody answers there.
    TevView(const std::string& place, std::string image);
    ~TevView();
    TevView(const TevView&) = delete;
    TevView& operator=(const TevView&) = delete;

    // What has come of a rendering: Wishes::on_part.
    void show(const Rendering& r, RenderedPart part, const PixelRect& where);

private:
    void send(const TevPacket& packet);
    void send_part(const Rendering& r, const std::string& layer, const PixelRect& where);
    void open_image(int width, int height);

    std::string place_, image_;
    int socket_ = -1;            // -1: nobody there
    int width_ = 0, height_ = 0; // of the image that the viewer has; 0: none
};

// For Wishes::on_part; nothing without a viewer.
std::function<void(const Rendering&, RenderedPart, const PixelRect&)>
viewer_of(std::optional<TevView>& viewer);

} // namespace pnr
