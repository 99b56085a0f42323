// A script of a tiny array: rays with their ways, what they meet, what they send. search.hpp runs it in every
// possible order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/machine/message.hpp"

namespace raycell::protocol {

/// What a ray meets at the end of its way.
enum class End : std::uint8_t {
    hit,       ///< takes a slot and waits for its children
    direct,    ///< a hit that waits for nothing: straight through the shading unit
    answer,    ///< a verdict on a source, or the background: answered where the ray is
    exterior,  ///< over the border to an exterior processor
    silent     ///< a precast ray that reaches its source
};

/// One ray. At any time it is unsent, in some place, or answered: one place per ray is the whole state.
struct Ray {
    std::string name;
    int x = 0;  ///< cell that sends it
    int y = 0;
    int end_x = 0;  ///< cell where its way ends; for `exterior` the one at the border
    int end_y = 0;
    End end = End::answer;
    int generation = 0;
    /// Rays whose slots wait for it; any of them may send it (more than one: memo). Empty: the cell itself
    /// sends it (a primary or a precast ray).
    std::vector<int> parents;
    std::vector<std::uint16_t> way;   ///< buffers that it passes, in order
    std::vector<std::uint16_t> back;  ///< buffers that its answer passes
};

/// A tiny array and the rays in it. Ways and buffer classes come from the model's own code.
class Script {
  public:
    /// `depth`: messages per buffer. Each place counts as a buffer of its own; rays pass one place after the
    /// other.
    Script(int width, int height, Networks networks, int depth = 1);

    /// Adds a ray from the middle of cell (x, y) towards (dx, dy) over `hops` borders of cells (one more to
    /// the exterior); dx = dy = 0 is a ray along z. Returns its index. Throws std::invalid_argument if its
    /// way leaves the array elsewhere.
    int add(const std::string& name, int x, int y, double dx, double dy, int hops, End end);
    /// Adds a ray that the slot of `parent` sends from the cell where the parent's way ends.
    int add_child(int parent, const std::string& name, double dx, double dy, int hops, End end);
    /// The slot of `parent` waits for `ray` too, or sends it if it is first (memo).
    void also_asked_by(int ray, int parent) { rays_[std::size_t(ray)].parents.push_back(parent); }

    const std::vector<Ray>& rays() const { return rays_; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Buffers are numbered by place, then class, then link. A link counts with the cell that it leaves (from
    /// outside: that it enters).
    int buffer_count() const { return width_ * height_ * side_count * classes_.count * 2 * depth_; }
    std::string buffer_name(int buffer) const;
    /// Number of generations that have to wait.
    int waiting_generations() const;

  private:
    void pass(std::vector<std::uint16_t>& way, int x, int y, Side towards, int index) const;
    std::vector<std::uint16_t> way_home(const Ray& ray, Side border) const;

    int width_;
    int height_;
    int depth_;
    BufferClasses classes_;
    std::vector<Ray> rays_;
};

}  // namespace raycell::protocol
