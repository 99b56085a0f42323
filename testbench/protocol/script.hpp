// What happens in a tiny array, written down: rays with their ways, what they meet, what they send. The
// search in search.hpp runs it in every possible order.
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
    answer,    ///< a verdict on a source, or the background: answered where it stands
    exterior,  ///< over the border to an exterior processor
    silent     ///< a precast ray that reaches its source
};

/// One ray. It is somewhere at any time, or not yet sent, or answered: one place per ray is the whole state.
struct Ray {
    std::string name;
    int x = 0;  ///< cell that sends it
    int y = 0;
    int end_x = 0;  ///< cell where its way ends; that of the border for `exterior`
    int end_y = 0;
    End end = End::answer;
    int generation = 0;
    /// Rays whose slots ask for it, any of them may send it and all of them wait for it (more than one:
    /// memo). Empty: the cell itself sends it (a primary or a precast ray).
    std::vector<int> parents;
    std::vector<std::uint16_t> way;   ///< buffers that it passes, in order
    std::vector<std::uint16_t> back;  ///< buffers that its answer passes
};

/// A tiny array and the rays in it. Ways and buffer classes come from the model's own code.
class Script {
  public:
    /// `depth`: messages per buffer; each place of a buffer counts as one of its own, passed one after the
    /// other.
    Script(int width, int height, Networks networks, int depth = 1);

    /// A ray from the middle of cell (x, y) towards (dx, dy) over `hops` borders of cells (one more to the
    /// exterior); dx = dy = 0 is a ray along z. Returns its index. Throws std::invalid_argument if the way
    /// leaves the array elsewhere.
    int add(const std::string& name, int x, int y, double dx, double dy, int hops, End end);
    /// A ray that the slot of `parent` sends from the cell where that one's way ends.
    int add_child(int parent, const std::string& name, double dx, double dy, int hops, End end);
    /// The slot of `parent` waits for `ray` too, or asks for it if it comes first (memo).
    void also_asked_by(int ray, int parent) { rays_[std::size_t(ray)].parents.push_back(parent); }

    const std::vector<Ray>& rays() const { return rays_; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Buffers have numbers: place in it, class, link by the cell that it leaves (or, from outside, enters).
    int buffer_count() const { return width_ * height_ * side_count * classes_.count * 2 * depth_; }
    std::string buffer_name(int buffer) const;
    /// Generations that have to wait.
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
