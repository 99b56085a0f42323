#include "testbench/protocol/script.hpp"

#include <algorithm>
#include <stdexcept>

namespace raycell::protocol {

Script::Script(int width, int height, Networks networks, int depth)
    : width_(width), height_(height), depth_(depth), classes_(buffer_classes(networks)) {}

/// Appends the buffer at the far end of the link that leaves (x, y) towards a side, also over the border.
/// Links from the border inwards are numbered by the cell that they lead to, in the second half.
void Script::pass(std::vector<std::uint16_t>& way, int x, int y, Side towards, int index) const {
    const bool inwards = x < 0 || x >= width_ || y < 0 || y >= height_;
    if (inwards) {
        x += step_x(towards);
        y += step_y(towards);
    }
    const int cell = y * width_ + x + (inwards ? width_ * height_ : 0);
    const int buffer = (cell * side_count + int(towards)) * classes_.count + index;
    for (int place = 0; place < depth_; ++place) way.push_back(std::uint16_t(buffer * depth_ + place));
}

std::string Script::buffer_name(int buffer) const {
    const int place = buffer % depth_;
    buffer /= depth_;
    const int index = buffer % classes_.count;
    const int side = buffer / classes_.count % side_count;
    int cell = buffer / classes_.count / side_count;
    const bool inwards = cell >= width_ * height_;
    if (inwards) cell -= width_ * height_;
    constexpr const char* sides[] = {"east", "south", "west", "north"};
    return std::string(inwards ? "border into (" : "(") + std::to_string(cell % width_) + ", " +
           std::to_string(cell / width_) + ")." + sides[side] +
           (index == classes_.answer && classes_.count > 1 ? " answers" : " class " + std::to_string(index)) +
           (depth_ > 1 ? " place " + std::to_string(place) : "");
}

std::vector<std::uint16_t> Script::way_home(const Ray& ray, Side border) const {
    std::vector<std::uint16_t> way;
    int x = ray.end_x;
    int y = ray.end_y;
    if (ray.end == End::exterior) {
        const Side back = opposite(border);
        pass(way, x + step_x(border), y + step_y(border), back, classes_.answer);
    }
    while (x != ray.x || y != ray.y) {  // as Cell::route: along x, then along y
        const Side side =
            x != ray.x ? (ray.x > x ? Side::east : Side::west) : (ray.y > y ? Side::south : Side::north);
        pass(way, x, y, side, classes_.answer);
        x += step_x(side);
        y += step_y(side);
    }
    return way;
}

int Script::add(const std::string& name, int x, int y, double dx, double dy, int hops, End end) {
    Ray ray;
    ray.name = name;
    ray.x = x;
    ray.y = y;
    ray.end = end;
    raycell::Ray real;
    real.position = {0.5, 0.5, 0};
    const double dz = dx == 0 && dy == 0 ? 1 : 0;
    set_direction(real, glm::normalize(dvec3(dx, dy, dz)), exact_arithmetic());
    real.outside = end == End::exterior;  // what leaves through the back goes on to the border
    Side border = Side::east;
    for (int hop = 0; hop < hops + (end == End::exterior ? 1 : 0); ++hop) {
        const Crossing crossing = real.outside ? border_crossing(real, exact_arithmetic())
                                               : next_crossing(real, exact_arithmetic());
        border = crossing.side;
        const int to_x = x + step_x(border);
        const int to_y = y + step_y(border);
        const bool leaves = to_x < 0 || to_x >= width_ || to_y < 0 || to_y >= height_;
        if (leaves != (hop == hops))
            throw std::invalid_argument("ray " + name + " leaves the array elsewhere");
        pass(ray.way, x, y, border, classes_.ray(real));
        if (leaves) break;
        cross(real, crossing, exact_arithmetic());
        x = to_x;
        y = to_y;
    }
    ray.end_x = x;
    ray.end_y = y;
    ray.back = way_home(ray, border);
    rays_.push_back(ray);
    return int(rays_.size()) - 1;
}

int Script::add_child(int parent, const std::string& name, double dx, double dy, int hops, End end) {
    const Ray from = rays_[std::size_t(parent)];
    const int child = add(name, from.end_x, from.end_y, dx, dy, hops, end);
    rays_.back().generation = from.generation + 1;
    rays_.back().parents = {parent};
    return child;
}

int Script::waiting_generations() const {
    int most = 0;
    for (const Ray& ray : rays_) {
        if (ray.end == End::hit) most = std::max(most, ray.generation + 1);
    }
    return most;
}

}  // namespace raycell::protocol
