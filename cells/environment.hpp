// What all cells of an array share: settings, costs, pools, meters.
#pragma once

#include <algorithm>
#include <optional>

#include "cells/array_share.hpp"
#include "cells/channels/message.hpp"
#include "cells/clock/scheduler.hpp"
#include "cells/meters/meters.hpp"
#include "cells/units/time_out.hpp"
#include "model/machine/load_wire.hpp"
#include "model/machine/wire.hpp"
#include "model/picture/picture.hpp"
#include "model/tracing/pixel_sum.hpp"

namespace raycell {

class Link;

enum class Phase : std::uint8_t { load, precast, trace };

/// A tested ray that wants to move on.
struct WaitingRay {
    Cycle since;
    std::size_t place;
    RayPacket* packet;
};

/// Cycles on a link, by kind of message.
struct LinkCycles {
    int ray;
    int shadow_ray;
    int intensity;
    int verdict;
};

/// The constant data that all cells share.
struct CellConfig {
    const PictureSettings settings;
    const MachineSettings machine;
    Context context;
    MessageBits bits;
    LinkCycles cycles;  ///< for `bits`; computed once, to save a division per hop
    BufferClasses classes;
    VoxelBits voxel_bits;
    int kept_span_bits;  ///< of a span that waits for its voxel
    int own_rays;        ///< primary rays of a cell that may be under way at once
    /// Cycles from a primary ray of a cell to the next of its pixels, which is made meanwhile.
    std::uint32_t primary_cycles;
    /// Cycles from an answer's arrival until its cell must look at it; 0 where rays and answers share a
    /// buffer.
    int answer_routing;
    std::optional<Wire> wire;           ///< with MachineSettings::wire_check
    std::optional<LoadWire> load_wire;  ///< the same

    /// `scene` and `traffic` (may be null) must outlive it; the settings are copied.
    CellConfig(const CellScene& scene, const PictureSettings& picture_settings,
               const MachineSettings& machine_settings, const SyntheticTraffic* traffic);

    /// Lanes of the feed: not more than there are rows.
    int feed_lanes() const { return std::min(machine.feed_lanes, height()); }
    int width() const { return context.scene.frame.width; }
    int height() const { return context.scene.frame.height; }
    const CostTable& costs() const { return machine.costs; }
    int cycles_for(int message_bits_) const { return link_cycles(message_bits_, machine.link_bits); }
    int load_bits(const LoadItem& item) const;
    /// Cycles of a load message on a link of the feed: from geometry to the rows' distributors.
    int feed_cycles(int message_bits_) const { return link_cycles(message_bits_, machine.feed_bits); }
    /// Gives a link its random stalls, if the settings ask for any; its name tells links apart.
    void stall(Link& link, const std::string& name) const;
};

/// CellConfig and the shared state that changes during a run.
struct Environment : CellConfig {
    const ArrayShare share;
    Scheduler& scheduler;
    Picture& picture;
    std::vector<PixelSum> sums;  ///< of every pixel; empty with one sample a pixel
    MessagePools pools;
    Pool<TimeOut::Counts> wait_counts;
    Meters meters;
    Phase phase = Phase::load;
    Cycle phase_start = 0;
    bool draining = false;  ///< no cell sends new rays; a message left in a buffer at the end is deadlocked
    std::vector<WaitingRay> waiting;  ///< scratch of the cell that is running

    /// With a wire check: a message that sets out is packed, and its receiver gets what unpacks, so that
    /// nothing travels that is not in its bits. Its id stays, by which reports name it. Throws
    /// std::runtime_error for what has no code.
    void over_wire(RayPacket& packet) {
        if (wire) pack_and_unpack(packet);
    }
    void over_wire(Answer& answer) {
        if (wire) pack_and_unpack(answer);
    }
    /// The same for a load message, which is charged for so many bits.
    void over_wire(LoadItem& item, int charged) {
        if (load_wire) pack_and_unpack(item, charged);
    }

    /// `part`: the rows that this process simulates; null: the whole array.
    Environment(const CellScene& scene, const PictureSettings& picture_settings,
                const MachineSettings& machine_settings, Scheduler& s, Picture& p,
                const SyntheticTraffic* traffic = nullptr, const ArrayShare* part = nullptr)
        : CellConfig(scene, picture_settings, machine_settings, traffic),
          share(part ? *part : ArrayShare(scene.frame.height)),
          scheduler(s),
          picture(p),
          sums(settings.samples > 1 ? p.pixels.size() : 0) {
        meters.pixel_hops.resize(p.pixels.size());
    }

    /// Counts a hop of a ray or of its answer for the ray's pixel; only in phase trace.
    void count_hop(std::uint64_t ray) {
        if (phase == Phase::trace) ++meters.pixel_hops[pixel_of(ray)];
    }

  private:
    void pack_and_unpack(RayPacket& packet);
    void pack_and_unpack(Answer& answer);
    void pack_and_unpack(LoadItem& item, int charged);
    WireBits exchange(LoadItem& item) const;
    template <typename F, typename U>
    auto checked(const F& what, const U& unpacked);
};

}  // namespace raycell
