// Pictures as files: OpenEXR with all that is known of each pixel, PNG to look at.
#pragma once

#include <string>
#include <vector>

#include "model/picture/picture.hpp"

namespace raycell {

/// Longest side of a picture file, pixels: that of the largest array.
constexpr int longest_side = 4096;

class NewFile;

// All functions throw std::runtime_error that names the file and the reason. The writers to a path publish
// the file (new_file.hpp); those to a NewFile leave that to the caller.

/// Writes every field of every pixel (ZIP compression). Channels:
///   R G B          float  colour, linear in the model's intensities
///   Z              float  depth of the first hit, cell widths; infinity where the background is seen
///   N.X N.Y N.Z    float  normal of the first hit, turned to the ray, cell coordinates; 0 for background
///   polygon        uint   id of the first hit; 4294967295 for background
///   cycle          uint   trace cycle in which the pixel was complete (timed engine only)
///   hops           uint   hops of all rays and answers of the pixel's tree
///   postponed      uint   times that a ray of the tree was destroyed and sent again (timed engine only)
void write_exr(const Picture& picture, NewFile& file);
void write_exr(const Picture& picture, const std::string& path);

/// Reads the channels above; R, G and B must be there. Names of others that are absent are appended to
/// `absent` if given, and their fields keep Pixel's defaults.
Picture read_exr(const std::string& path, std::vector<std::string>* absent = nullptr);

/// Writes colours with 8 bits per channel, clamped to [0, 1] and rounded to the nearest of 256 steps. No
/// transfer curve is applied: scene files of 1990 give the values that the display is sent, and the PNG
/// declares them as such (sRGB chunk). Throws for NaN, naming the pixel.
void write_png(const Picture& picture, NewFile& file);
void write_png(const Picture& picture, const std::string& path);

/// Reads colours as write_png writes them, k/255; alpha is laid over black. Other fields keep their defaults.
Picture read_png(const std::string& path);

}  // namespace raycell
