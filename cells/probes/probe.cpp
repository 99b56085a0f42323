#include "cells/probes/probe.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "cells/probes/save_file.hpp"
#include "model/numbers/bits.hpp"

namespace raycell {
namespace {

constexpr const char* phase_names[] = {"load", "precast", "trace"};
constexpr const char* state_names[] = {"idle", "busy", "blocked"};
constexpr const char* operation_names[] = {"none",  "walk",   "compare",    "set_up",
                                           "shade", "direct", "make_voxel", "pass_on"};
constexpr const char* slot_names[] = {"empty", "to_set_up", "in_setup", "waiting", "in_shading", "to_answer"};
// Two names for empty buffers and messages on the wires, then the names of RayKind, Answer::Kind and
// LoadItem::Kind, in their order.
constexpr const char* type_names[] = {"none",    "on_wires",  "primary", "reflected",   "refracted",
                                      "shadow",  "memo",      "precast", "intensity",   "lit",
                                      "blocked", "postponed", "setup",   "features",    "polygon",
                                      "surface", "trapeze",   "span",    "end_of_scene"};
constexpr std::uint64_t no_message = 0;
constexpr std::uint64_t on_wires = 1;
constexpr std::uint64_t first_ray = 2;
constexpr std::uint64_t first_answer = 8;
constexpr std::uint64_t first_load = 12;

/// Bits of a signal with numbers from 0 to `most`; at least 1.
int bits_for_value(int most) { return std::max(bits_for(most + 1), 1); }

struct Head {
    std::uint64_t type = no_message;
    std::uint64_t ray = VcdWriter::no_ray;
};

Head head_of(const Message& message) {
    switch (message.kind) {
        case Message::Kind::ray:
            return {first_ray + std::uint64_t(message.ray->ray.kind), message.ray->ray.id};
        case Message::Kind::answer:
            return {first_answer + std::uint64_t(message.answer->kind), message.answer->id};
        case Message::Kind::load:
            return {first_load + std::uint64_t(message.load->kind), VcdWriter::no_ray};
        case Message::Kind::none:
            break;
    }
    return {};
}

std::string scope_of(const Cell& cell) {
    return "cell_" + std::to_string(cell.x()) + "_" + std::to_string(cell.y());
}

std::string megabytes(double bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f MB", bytes < 100e6 ? 1 : 0, bytes / 1e6);
    return text;
}

}  // namespace

std::uint64_t picoseconds(const sc_core::sc_time& period) {
    return std::uint64_t(std::llround(period.to_seconds() * 1e12));
}

Probe::Probe(std::vector<const Cell*> cells, const Environment& environment, std::FILE* file,
             const ProbeSettings& settings, std::function<void(const std::string&)> warn)
    : watched_(std::move(cells)),
      env_(environment),
      settings_(settings),
      warn_(std::move(warn)),
      vcd_(file, picoseconds(environment.scheduler.period()), settings.limit) {}

// ---- declarations
// --------------------------------------------------------------------------------------------

void Probe::declare() {
    if (declared_) return;
    declared_ = true;
    vcd_.open_scope("raycell");
    phase_ = vcd_.add_word("phase", phase_names);
    cycle_ = vcd_.add_number("cycle", 32);
    cells_.reserve(watched_.size());
    for (const Cell* cell : watched_) declare_cell(*cell);
    vcd_.close_scope();
}

Probe::UnitSignals Probe::declare_unit(const char* name, bool of_rays) {
    vcd_.open_scope(name);
    UnitSignals unit{};
    unit.state = vcd_.add_word("state", state_names);
    unit.operation = vcd_.add_word("operation", operation_names);
    if (of_rays) unit.ray = vcd_.add_ray("ray");
    vcd_.close_scope();
    return unit;
}

void Probe::declare_buffer(CellSignals& cell, const Link& link, int index, const std::string& where,
                           const char* name) {
    vcd_.open_scope(name);
    BufferSignals buffer{};
    buffer.link = &link;
    buffer.index = index;
    buffer.last_occupancy = 0;
    buffer.full = vcd_.add_flag("full");
    buffer.occupancy = vcd_.add_number("occupancy", bits_for_value(env_.machine.buffer_depth));
    buffer.type = vcd_.add_word("type", type_names);
    buffer.ray = vcd_.add_ray("ray");
    buffer.stall = vcd_.add_word("stall", stall_names.data());
    buffer.name = where + "." + name;
    cell.buffers.push_back(buffer);
    vcd_.close_scope();
}

void Probe::declare_side(CellSignals& cell, int side) {
    const Link* link = cell.cell->input(Side(side));
    if (!link) return;
    const BufferClasses& classes = env_.classes;
    const bool horizontal = side % 2 == 0;
    vcd_.open_scope(name_of(Side(side)));
    for (int index = 0; index < classes.count; ++index) {
        // A message that comes in at one side runs towards the opposite side.
        if (!classes.used(index, horizontal, opposite(Side(side)))) continue;
        declare_buffer(cell, *link, index, scope_of(*cell.cell) + "." + name_of(Side(side)),
                       class_name(classes.networks, index));
    }
    vcd_.close_scope();
}

void Probe::declare_cell(const Cell& cell) {
    CellSignals& signals = cells_.emplace_back();
    signals.cell = &cell;
    vcd_.open_scope(scope_of(cell));
    for (int side = 0; side < side_count; ++side) declare_side(signals, side);
    const Link* load = cell.load_input();
    if (load && load != cell.input(Side::west)) {
        vcd_.open_scope("distributor");
        declare_buffer(signals, *load, 0, scope_of(cell) + ".distributor", "load");
        vcd_.close_scope();
    }
    for (std::size_t unit = 0; unit < cell.traversal().count(); ++unit)
        signals.traversal.push_back(declare_unit(("traversal_" + std::to_string(unit)).c_str(), true));
    signals.shading = declare_unit("shading", true);
    signals.loading = declare_unit("loading", false);
    vcd_.open_scope("own");
    signals.own_type = vcd_.add_word("type", type_names);
    signals.own_ray = vcd_.add_ray("ray");
    signals.own_stall = vcd_.add_word("stall", stall_names.data());
    vcd_.close_scope();
    vcd_.open_scope("ray_store");
    signals.store_occupancy = vcd_.add_number("occupancy", bits_for_value(cell.ray_store().capacity()));
    for (int slot = 0; slot < cell.ray_store().capacity(); ++slot) {
        vcd_.open_scope("slot_" + std::to_string(slot));
        SlotSignals s{};
        s.state = vcd_.add_word("state", slot_names);
        s.ray = vcd_.add_ray("ray");
        s.child = vcd_.add_ray("child");
        s.stall = vcd_.add_word("stall", stall_names.data());
        signals.slots.push_back(s);
        vcd_.close_scope();
    }
    vcd_.close_scope();
    vcd_.close_scope();
}

// ---- samples
// -------------------------------------------------------------------------------------------------

void Probe::sample_buffer(const Cell& cell, BufferSignals& buffer, Cycle now) {
    buffer.last_occupancy = buffer.link->occupancy(buffer.index);
    buffer.quiet = buffer.quiet && buffer.last_occupancy == 0;
    vcd_.set(buffer.full, buffer.last_occupancy >= env_.machine.buffer_depth);
    vcd_.set(buffer.occupancy, std::uint64_t(buffer.last_occupancy));
    Head head = head_of(buffer.link->front(buffer.index));
    if (head.type == no_message && buffer.last_occupancy > 0) head.type = on_wires;
    buffer.on_wires = head.type == on_wires;
    vcd_.set(buffer.type, head.type);
    vcd_.set(buffer.ray, head.ray);
    vcd_.set(buffer.stall, std::uint64_t(CellView(cell, now).stall_of(*buffer.link, buffer.index)));
}

void Probe::sample_unit(const UnitSignals& signals, const UnitView& unit, bool of_rays) {
    vcd_.set(signals.state, std::uint64_t(unit.state));
    vcd_.set(signals.operation, std::uint64_t(unit.operation));
    if (of_rays) vcd_.set(signals.ray, unit.ray);
}

void Probe::sample_slots(const CellSignals& signals, const Cell& cell, Cycle now) {
    const RayStore& store = cell.ray_store();
    vcd_.set(signals.store_occupancy, std::uint64_t(store.used()));
    for (std::uint32_t i = 0; i < signals.slots.size(); ++i) {
        const SlotSignals& s = signals.slots[i];
        const bool used = i < store.touched() && store[i].state != Slot::State::empty;
        vcd_.set(s.state, used ? std::uint64_t(store[i].state) : 0);
        vcd_.set(s.ray, used ? store[i].packet->ray.id : VcdWriter::no_ray);
        vcd_.set(s.child, used && store[i].child ? store[i].child->ray.id : VcdWriter::no_ray);
        vcd_.set(s.stall, used ? std::uint64_t(CellView(cell, now).stall_of(store[i])) : 0);
    }
}

void Probe::sample_cell(CellSignals& signals, Cycle now) {
    const Cell& cell = *signals.cell;
    const CellView view(cell, now);
    for (BufferSignals& buffer : signals.buffers) sample_buffer(cell, buffer, now);
    for (std::size_t unit = 0; unit < signals.traversal.size(); ++unit)
        sample_unit(signals.traversal[unit], view.traversal_unit(unit), true);
    sample_unit(signals.shading, view.shading_unit(), true);
    sample_unit(signals.loading, view.loading_unit(), false);
    const RayPacket* own = cell.injector().ray();
    vcd_.set(signals.own_type, own ? first_ray + std::uint64_t(own->ray.kind) : no_message);
    vcd_.set(signals.own_ray, own ? own->ray.id : VcdWriter::no_ray);
    vcd_.set(signals.own_stall, own ? std::uint64_t(view.stall_of(*own)) : 0);
    sample_slots(signals, cell, now);
}

void Probe::sample_all(Cycle now, bool everything) {
    vcd_.set(phase_, std::uint64_t(env_.phase));
    vcd_.set(cycle_, now);
    for (CellSignals& cell : cells_) {
        // A cell changes when it runs. Its buffers also change when a neighbour sends and when a message
        // becomes visible. (Room at an output that refused the cell wakes it.)
        const auto changed = [](const BufferSignals& buffer) {
            return buffer.on_wires || buffer.link->occupancy(buffer.index) != buffer.last_occupancy;
        };
        if (everything || cell.cell->woken() == now ||
            std::any_of(cell.buffers.begin(), cell.buffers.end(), changed)) {
            sample_cell(cell, now);
        }
    }
}

void Probe::begin(Cycle cycle) {
    declare();
    begun_ = true;
    sample_all(env_.scheduler.now(), true);
    vcd_.begin(cycle);
    last_phase_ = env_.phase;
    phase_bytes_ = vcd_.bytes();
    look_at_size(cycle);
}

void Probe::sample(Cycle now) {
    if (done_) return;
    if (!begun_) {
        // The present state holds until the window begins if no cycle is run before that.
        const Cycle next = env_.scheduler.next();
        if (now < settings_.from && (next == never || next <= settings_.from)) return;
        begin(std::max(now, settings_.from));
        return;
    }
    if (now > settings_.to) {
        finish(now);
        return;
    }
    vcd_.at(now);
    sample_all(now, false);
    if (vcd_.stopped() || vcd_.bytes() >= look_at_) look_at_size(now);
}

void Probe::finish(Cycle last) {
    if (done_) return;
    done_ = true;
    declare();
    vcd_.end(std::min(std::max(last, settings_.from), settings_.to) + 1);
}

// ---- size
// ----------------------------------------------------------------------------------------------------

/// The expected final size of the dump in bytes, extrapolated from the finished pixels or from the window's
/// cycles, whichever gives less; 0 while neither is known.
double Probe::expected_bytes(Cycle now) const {
    constexpr double least_share = 0.01;
    const double bytes = double(vcd_.bytes());
    double expected = 0;
    if (settings_.to != never) {
        const double share = double(now - settings_.from + 1) / double(settings_.to - settings_.from + 1);
        if (share > least_share) expected = bytes / share;
    }
    const auto pixels = double(env_.picture.pixels.size());
    const double share = env_.phase == Phase::trace ? double(env_.meters.counters.pixels_done) / pixels : 0;
    if (share > least_share) {
        const double before = double(phase_bytes_);
        const double by_pixels = before + (bytes - before) / share;
        expected = expected > 0 ? std::min(expected, by_pixels) : by_pixels;
    }
    return expected;
}

void Probe::look_at_size(Cycle now) {
    constexpr std::uint64_t bytes_between_looks = 1000000;
    constexpr double worth_a_warning = 1e9;
    if (vcd_.stopped()) {
        warn_("the dump has reached --vcd-limit (" + megabytes(double(settings_.limit)) +
              ") and ends before cycle " + std::to_string(now) + "; the run goes on");
        finish(now);
        return;
    }
    if (env_.phase != last_phase_) {
        last_phase_ = env_.phase;
        phase_bytes_ = vcd_.bytes();
    }
    look_at_ = vcd_.bytes() + std::min(bytes_between_looks, settings_.limit / 16);
    const double bound = std::min(worth_a_warning, double(settings_.limit));
    const double expected = expected_bytes(now);
    // Half the bound, for dumps whose final size can't be estimated.
    if (warned_ || (expected <= bound && double(vcd_.bytes()) <= bound / 2)) return;
    warned_ = true;
    std::string text = "the dump has " + megabytes(double(vcd_.bytes())) + " in cycle " + std::to_string(now);
    if (expected > 0) text += " and would come to about " + megabytes(expected);
    warn_(text + "; it ends at --vcd-limit (" + megabytes(double(settings_.limit)) +
          "). Fewer cells (--probe) or cycles (--window) make it smaller");
}

std::string Probe::save_file(const std::string& name) const {
    std::set<std::string> quiet;
    for (const CellSignals& cell : cells_) {
        for (const BufferSignals& buffer : cell.buffers) {
            if (buffer.quiet) quiet.insert(buffer.name);
        }
    }
    const bool marked = settings_.mark != never;
    SaveFileView view;
    view.cycle = vcd_.display_time(1);
    view.from = vcd_.display_time(settings_.from);
    if (marked) {
        constexpr Cycle before = 100;  // cycles to the left of the marker
        view.marker = std::int64_t(vcd_.display_time(settings_.mark));
        view.from =
            vcd_.display_time(std::max(settings_.from, settings_.mark - std::min(settings_.mark, before)));
    }
    return gtkwave_save_file(vcd_.declarations(), name, view, quiet);
}

}  // namespace raycell
