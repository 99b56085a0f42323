#include "testbench/common/film.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace raycell {
namespace {

constexpr const char* layer_names[] = {"loads", "voxels", "rays", "answers", "slots", "pixels_done"};
constexpr const char* phase_names[] = {"load", "precast", "trace"};

/// Messages and rays that are in a cell and in no buffer.
std::uint32_t rays_inside(const Cell& cell) {
    std::uint32_t count = (cell.injector().ray() != nullptr) + (cell.shading().direct_ray() != nullptr);
    for (std::uint32_t i = 0; i < cell.ray_store().touched(); ++i)
        count += cell.ray_store()[i].child != nullptr;
    return count;
}

/// Pixels of a cell's block that are complete.
std::uint32_t done_pixels(const Environment& env, const Cell& cell) {
    const raycell::Frame& frame = env.context.scene.frame;
    std::uint32_t done = 0;
    for (int pixel = 0; pixel < frame.block(); ++pixel)
        done += env.picture.pixels[frame.pixel_index(cell.x(), cell.y(), pixel)].cycle > 0;
    return done;
}

}  // namespace

Film::Film(Machine& machine, int frames)
    : machine_(machine), most_(std::size_t(std::max(frames / 4, 1)) * 2) {
    const Environment& env = machine.environment();
    block_ = (std::max(env.width(), env.height()) + most_blocks - 1) / most_blocks;
    columns_ = (env.width() + block_ - 1) / block_;
    rows_ = (env.height() + block_ - 1) / block_;
}

Film::Reel& Film::current() { return reels_[machine_.environment().phase == Phase::load ? 0 : 1]; }

void Film::before(Cycle now) {
    Reel& reel = current();
    if (reel.next == never) reel.next = now - 1;
    while (reel.next < now) {
        take(reel, reel.next);
        reel.next += reel.interval;
    }
}

void Film::finish(Cycle last) {
    before(last);
    take(current(), last);  // always the state at the end, whatever the distance to the frame before
}

/// In the buffers that lead to the cell, or on the wires to them.
void Film::add_messages(Frame& frame, const Cell& cell, std::size_t block) const {
    const Environment& env = machine_.environment();
    if (env.phase == Phase::load) {
        if (const Link* link = cell.load_input())
            frame.maps[loads][block] += std::uint32_t(link->occupancy(0));
        return;
    }
    for (int side = 0; side < side_count; ++side) {
        const Link* link = cell.input(Side(side));
        for (int index = 0; link && index < env.classes.count; ++index) {
            for (int place = 0; place < link->occupancy(index); ++place) {
                const bool ray = link->held(index, place).message.kind == Message::Kind::ray;
                ++frame.maps[ray ? rays : answers][block];
            }
        }
    }
    frame.maps[rays][block] += rays_inside(cell);
}

void Film::take(Reel& reel, Cycle cycle) const {
    if (!reel.frames.empty() && reel.frames.back().cycle == cycle) return;
    Frame frame;
    frame.cycle = cycle;
    frame.phase = machine_.environment().phase;
    for (Map& map : frame.maps) map.assign(std::size_t(columns_) * std::size_t(rows_), 0);
    for (const Cell& cell : machine_.array().cells()) {
        const std::size_t block =
            std::size_t(cell.y() / block_) * std::size_t(columns_) + std::size_t(cell.x() / block_);
        add_messages(frame, cell, block);
        frame.maps[voxels][block] += std::uint32_t(cell.store().voxels.size());
        frame.maps[slots][block] += std::uint32_t(cell.ray_store().used());
        frame.maps[pixels_done][block] += done_pixels(machine_.environment(), cell);
    }
    reel.frames.push_back(std::move(frame));
    if (reel.frames.size() > most_) thin_out(reel);
}

/// Keeps every second frame. It is called with an odd number of them, so the first and the last stay.
void Film::thin_out(Reel& reel) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < reel.frames.size(); i += 2) {
        if (kept != i) reel.frames[kept] = std::move(reel.frames[i]);
        ++kept;
    }
    reel.frames.resize(kept);
    reel.interval *= 2;
}

std::string Film::json() const {
    using Json = nlohmann::ordered_json;
    std::vector<const Frame*> frames;
    for (const Reel& reel : reels_) {
        for (const Frame& frame : reel.frames) frames.push_back(&frame);
    }
    Json cycles = Json::array();
    Json phases = Json::array();
    for (const Frame* frame : frames) {
        cycles.push_back(frame->cycle);
        phases.push_back(phase_names[std::size_t(frame->phase)]);
    }
    Json layers = Json::object();
    for (std::size_t layer = 0; layer < layer_count; ++layer) {
        Json changes = Json::array();
        Map before(std::size_t(columns_) * std::size_t(rows_), 0);
        for (const Frame* frame : frames) {
            Json pairs = Json::array();
            const Map& map = frame->maps[layer];
            for (std::size_t block = 0; block < map.size(); ++block) {
                if (map[block] == before[block]) continue;
                pairs.push_back(block);
                pairs.push_back(map[block]);
            }
            changes.push_back(std::move(pairs));
            before = map;
        }
        layers[layer_names[layer]] = std::move(changes);
    }
    const Json film = {{"cells_per_block", block_}, {"columns", columns_}, {"rows", rows_},
                       {"cycles", cycles},          {"phases", phases},    {"layers", layers}};
    return film.dump() + "\n";
}

}  // namespace raycell
