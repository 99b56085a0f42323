#include "testbench/common/picture_file.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "model/files/input_file.hpp"
#include "testbench/common/new_file.hpp"

namespace raycell {

namespace {

/// Replaces OpenEXR's own stream, whose destructor hides errors; stdio's error flag keeps them.
class ExrStream : public Imf::OStream {
  public:
    ExrStream(std::FILE* file, const std::string& name) : Imf::OStream(name.c_str()), file_(file) {}
    void write(const char bytes[], int n) override {
        if (std::fwrite(bytes, 1, std::size_t(n), file_) != std::size_t(n))
            throw std::runtime_error(reason_of(errno));
    }
    uint64_t tellp() override { return uint64_t(ftello(file_)); }
    void seekp(uint64_t position) override {
        if (fseeko(file_, off_t(position), SEEK_SET) != 0) throw std::runtime_error(reason_of(errno));
    }

  private:
    std::FILE* file_;
};

/// One scan line in the file's own types.
struct ExrRow {
    struct Sample {
        float r, g, b, z, nx, ny, nz;
        std::uint32_t polygon, cycle, hops, postponed, samples;
    };
    std::vector<Sample> samples;

    explicit ExrRow(int width) : samples(std::size_t(width)) {}
};

struct Channel {
    const char* name;
    Imf::PixelType type;
    std::size_t offset;  ///< in ExrRow::Sample
};

constexpr Channel channels[] = {
    {"R", Imf::FLOAT, offsetof(ExrRow::Sample, r)},
    {"G", Imf::FLOAT, offsetof(ExrRow::Sample, g)},
    {"B", Imf::FLOAT, offsetof(ExrRow::Sample, b)},
    {"Z", Imf::FLOAT, offsetof(ExrRow::Sample, z)},
    {"N.X", Imf::FLOAT, offsetof(ExrRow::Sample, nx)},
    {"N.Y", Imf::FLOAT, offsetof(ExrRow::Sample, ny)},
    {"N.Z", Imf::FLOAT, offsetof(ExrRow::Sample, nz)},
    {"polygon", Imf::UINT, offsetof(ExrRow::Sample, polygon)},
    {"cycle", Imf::UINT, offsetof(ExrRow::Sample, cycle)},
    {"hops", Imf::UINT, offsetof(ExrRow::Sample, hops)},
    {"postponed", Imf::UINT, offsetof(ExrRow::Sample, postponed)},
    {"samples", Imf::UINT, offsetof(ExrRow::Sample, samples)},
};
constexpr int samples_channel = int(std::size(channels)) - 1;  ///< only where a pixel has several
constexpr int colour_channels = 3;  ///< the first of the list, which every picture must have

ExrRow::Sample to_sample(const Pixel& p) {
    return {float(p.colour.r), float(p.colour.g), float(p.colour.b), float(p.depth), float(p.normal.x),
            float(p.normal.y), float(p.normal.z), p.polygon,         p.cycle,        p.hops,
            p.postponed,       p.samples};
}

Pixel to_pixel(const ExrRow::Sample& s) {
    Pixel pixel;
    pixel.colour = {s.r, s.g, s.b};
    pixel.depth = s.z;
    pixel.normal = {s.nx, s.ny, s.nz};
    pixel.polygon = s.polygon;
    pixel.cycle = s.cycle;
    pixel.hops = s.hops;
    pixel.postponed = s.postponed;
    pixel.samples = s.samples;
    return pixel;
}

/// A frame buffer that maps every line to `row`, whose first sample is the pixel with x = left.
Imf::FrameBuffer buffer_of(ExrRow& row, int left, const Imf::ChannelList& wanted) {
    Imf::FrameBuffer buffer;
    constexpr std::size_t stride = sizeof(ExrRow::Sample);
    char* base = reinterpret_cast<char*>(row.samples.data()) - std::ptrdiff_t(left) * std::ptrdiff_t(stride);
    for (const Channel& channel : channels)
        if (wanted.findChannel(channel.name))
            buffer.insert(channel.name, Imf::Slice(channel.type, base + channel.offset, stride, 0));
    return buffer;
}

void check_size(const char* what, const std::string& path, long long width, long long height) {
    if (width < 1 || height < 1 || width > longest_side || height > longest_side)
        fail(what, path,
             "the picture is " + std::to_string(width) + "x" + std::to_string(height) +
                 ", allowed are 1x1 to " + std::to_string(longest_side) + "x" + std::to_string(longest_side));
}

void write_exr_rows(const Picture& picture, Imf::OStream& stream) {
    Imf::Header header(picture.width, picture.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    const bool samples = std::any_of(picture.pixels.begin(), picture.pixels.end(),
                                     [](const Pixel& pixel) { return pixel.samples > 1; });
    for (const Channel& channel : channels)
        if (&channel != &channels[samples_channel] || samples)
            header.channels().insert(channel.name, Imf::Channel(channel.type));
    Imf::OutputFile file(stream, header);
    ExrRow row(picture.width);
    file.setFrameBuffer(buffer_of(row, 0, header.channels()));
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) row.samples[std::size_t(x)] = to_sample(picture.at(x, y));
        file.writePixels(1);
    }
}

void check_channels(const Imf::ChannelList& present, const std::string& path,
                    std::vector<std::string>* absent) {
    for (int i = 0; i < int(std::size(channels)); ++i) {
        const Imf::Channel* channel = present.findChannel(channels[i].name);
        if (!channel && i < colour_channels)
            fail("read", path, std::string("it has no channel ") + channels[i].name);
        if (!channel && absent && i != samples_channel) absent->push_back(channels[i].name);
        if (channel && (channel->xSampling != 1 || channel->ySampling != 1))
            fail("read", path, std::string("its channel ") + channels[i].name + " is subsampled");
    }
}

Picture read_exr_rows(Imf::InputFile& file, const std::string& path, std::vector<std::string>* absent) {
    const Imath::Box2i window = file.header().dataWindow();
    const long long width = (long long)(window.max.x) - window.min.x + 1;
    const long long height = (long long)(window.max.y) - window.min.y + 1;
    check_size("read", path, width, height);
    if (!file.isComplete()) fail("read", path, "it is truncated");
    check_channels(file.header().channels(), path, absent);
    ExrRow row(static_cast<int>(width));
    std::fill(row.samples.begin(), row.samples.end(), to_sample(Pixel()));
    file.setFrameBuffer(buffer_of(row, window.min.x, file.header().channels()));
    Picture picture;
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
    // Grows with what is read, so that a small file can't ask for the memory of a large one.
    for (int y = 0; y < picture.height; ++y) {
        file.readPixels(window.min.y + y);
        for (const ExrRow::Sample& sample : row.samples) picture.pixels.push_back(to_pixel(sample));
    }
    return picture;
}

std::uint8_t to_byte(double value, int x, int y, const std::string& path) {
    if (std::isnan(value))
        fail("write", path, "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ") is NaN");
    return std::uint8_t(std::lround(std::clamp(value, 0.0, 1.0) * 255));
}

/// libpng's description of a picture, freed by the destructor.
struct PngImage : png_image {
    PngImage() : png_image() { version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(this); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

void check_readable(const std::string& path) {
    const std::string fault = input_fault(path);
    if (!fault.empty()) fail("read", path, fault);
}

}  // namespace

void write_exr(const Picture& picture, NewFile& file) {
    check_size("write", file.path(), picture.width, picture.height);
    try {
        ExrStream stream(file.stream(), file.path());
        write_exr_rows(picture, stream);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail("write", file.path(), error.what());
    }
}

void write_exr(const Picture& picture, const std::string& path) {
    NewFile file(path);
    write_exr(picture, file);
    file.publish();
}

Picture read_exr(const std::string& path, std::vector<std::string>* absent) {
    check_readable(path);
    std::unique_ptr<Imf::InputFile> file;
    try {
        file = std::make_unique<Imf::InputFile>(path.c_str(), 0);
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        fail("read", path, error.what());
    }
    try {
        return read_exr_rows(*file, path, absent);
    } catch (const Iex::BaseExc& error) {
        fail("read", path, error.what());
    }
}

void write_png(const Picture& picture, NewFile& file) {
    const std::string& path = file.path();
    check_size("write", path, picture.width, picture.height);
    std::vector<std::uint8_t> bytes;
    bytes.reserve(picture.pixels.size() * 3);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            for (int c = 0; c < 3; ++c) bytes.push_back(to_byte(picture.at(x, y).colour[c], x, y, path));
    PngImage image;
    image.width = png_uint_32(picture.width);
    image.height = png_uint_32(picture.height);
    image.format = PNG_FORMAT_RGB;
    if (!png_image_write_to_stdio(&image, file.stream(), 0, bytes.data(), 0, nullptr) ||
        PNG_IMAGE_FAILED(image))
        fail("write", path, image.message);
}

void write_png(const Picture& picture, const std::string& path) {
    NewFile file(path);
    write_png(picture, file);
    file.publish();
}

Picture read_png(const std::string& path) {
    check_readable(path);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!file) fail("read", path, reason_of(errno));
    PngImage image;
    if (!png_image_begin_read_from_stdio(&image, file.get()) || PNG_IMAGE_FAILED(image))
        fail("read", path, image.message);
    check_size("read", path, image.width, image.height);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(image));
    const png_color black{0, 0, 0};
    if (!png_image_finish_read(&image, &black, bytes.data(), 0, nullptr) || PNG_IMAGE_FAILED(image))
        fail("read", path, image.message);
    Picture picture(int(image.width), int(image.height));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i].colour = dvec3(bytes[3 * i], bytes[3 * i + 1], bytes[3 * i + 2]) / 255.0;
    return picture;
}

}  // namespace raycell
