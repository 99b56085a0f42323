// What all cells of an array share: settings, costs, pools, counters.
#pragma once

#include <array>

#include "cells/array_share.hpp"
#include "cells/channels/message.hpp"
#include "cells/channels/observer.hpp"
#include "cells/clock/scheduler.hpp"
#include "cells/meters/ledger.hpp"
#include "cells/units/time_out.hpp"
#include "model/machine/untimed.hpp"
#include "model/numbers/hash.hpp"
#include "model/picture/picture.hpp"

namespace raycell {

class Link;

enum class Phase : std::uint8_t { load, precast, trace };

/// Counters of a run. Sums only: they do not depend on the order in which cells run.
struct Counters {
    RayCounts rays;
    std::uint64_t load_hops = 0;
    std::uint64_t rays_sent = 0;       ///< put on their way, again after a postponement included
    std::uint64_t rays_answered = 0;   ///< ended in an answer
    std::uint64_t rays_silent = 0;     ///< precast rays that reached their source
    std::uint64_t rays_destroyed = 0;  ///< postponed
    std::uint64_t answers_sent = 0;
    std::uint64_t answers_delivered = 0;
    std::uint64_t loads_sent = 0;       ///< spans and broadcast messages put into a row
    std::uint64_t loads_delivered = 0;  ///< dropped behind their last cell
    std::uint64_t cells_loaded = 0;     ///< end-of-scene marks seen
    std::uint64_t pixels_done = 0;
    std::uint64_t slots_used = 0;   ///< now, over all cells
    std::uint64_t slot_cycles = 0;  ///< sum over accepted rays of the cycles in the ray store
    std::uint64_t traversal_cycles = 0;
    std::uint64_t shading_cycles = 0;
    Cycle last_progress =
        0;  ///< last cycle in which an end-of-scene mark, or an answer other than "postponed", came home
};

/// Adds the counters of another part of the same machine.
void join(Counters& sum, const Counters& other);

/// A tested ray that wants to move on.
struct WaitingRay {
    Cycle since;
    std::size_t place;
    RayPacket* packet;
};

/// Cycles on a link of the messages that rays and answers are.
struct LinkCycles {
    int ray;
    int shadow_ray;
    int intensity;
    int verdict;
};

struct Environment {
    const PictureSettings settings;
    const MachineSettings machine;
    Context context;
    MessageBits bits;
    LinkCycles cycles;  ///< for `bits`: no division in every hop
    BufferClasses classes;
    /// Cycles from an answer's arrival until its cell need look at it; 0 where it may stand in a ray's way.
    int answer_routing;
    const ArrayShare share;
    Scheduler& scheduler;
    Picture& picture;
    /// Per pixel, for Pixel::hops: apart from the picture, because every hop of a traced ray comes here and a
    /// picture is larger than a cache.
    std::vector<std::uint32_t> pixel_hops;
    MessagePools pools;
    Pool<TimeOut::Counts> wait_counts;
    Counters counters;
    Ledger ledger;
    Phase phase = Phase::load;
    Cycle phase_start = 0;
    std::vector<WaitingRay> waiting;   ///< scratch of the cell that is running
    CellObserver* observer = nullptr;  ///< told what every cell does; null: nobody
    bool draining = false;  ///< no cell sends new rays: what still stands in a buffer at the end is locked

    /// The scene (and the traffic, which may be null) must outlive the environment; the settings are copied.
    /// Without `part` the whole array is simulated here.
    Environment(const CellScene& scene, const PictureSettings& picture_settings,
                const MachineSettings& machine_settings, Scheduler& s, Picture& p,
                const SyntheticTraffic* traffic = nullptr, const ArrayShare* part = nullptr)
        : settings(picture_settings),
          machine(machine_settings),
          context(scene, settings, traffic),
          bits(message_bits(settings, machine, context.arithmetic.formats())),
          cycles{cycles_for(bits.ray), cycles_for(bits.shadow_ray), cycles_for(bits.intensity),
                 cycles_for(bits.verdict)},
          classes(buffer_classes(machine.networks)),
          answer_routing(classes.count > 1 ? int(machine.costs.route_return) : 0),
          share(part ? *part : ArrayShare(scene.frame.height)),
          scheduler(s),
          picture(p),
          pixel_hops(p.pixels.size()) {}

    int width() const { return context.scene.frame.width; }
    int height() const { return context.scene.frame.height; }
    const CostTable& costs() const { return machine.costs; }
    int cycles_for(int message_bits_) const { return link_cycles(message_bits_, machine.link_bits); }
    int load_bits(const LoadItem& item) const;
    /// Gives a link its random stalls, if there are any, by its name.
    void stall(Link& link, const std::string& name) const;
};

}  // namespace raycell
