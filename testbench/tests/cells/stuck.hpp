// Runs an own scene that may not end, and checks what must hold however it ends.
#pragma once

#include <map>
#include <set>

#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {

struct Stuck {
    explicit Stuck(const std::string& scene,
                   const std::function<void(PictureSettings&, MachineSettings&)>& change) {
        expect_first_elaboration();
        settings.width = settings.height = 24;
        change(settings, machine);
        placed = place_own_scene(scene, settings);
        timed =
            std::make_unique<Machine>("machine", placed->scene, settings, machine, placed->exterior.get());
        result = timed->run();
    }
    /// What is not delivered is still there: no message was lost before the deadlock.
    void expect_conserved() {
        const Counters& c = result.counters;
        const std::uint64_t open = c.rays_sent - c.rays_answered - c.rays_silent - c.rays_destroyed;
        const std::uint64_t in_the_array = timed->environment().pools.rays.in_use();
        EXPECT_EQ(open, result.in_flight.rays);
        EXPECT_GE(open, in_the_array);
        EXPECT_LE(open, in_the_array + std::uint64_t(machine.exterior_processors));
        EXPECT_EQ(c.answers_sent - c.answers_delivered, timed->environment().pools.answers.in_use());
        EXPECT_EQ(c.loads_sent - c.loads_delivered, result.in_flight.loads);
    }
    void expect_report() {
        ASSERT_FALSE(result.report.empty());
        Cycle before = 0;
        for (const std::string& line : result.report) {
            EXPECT_TRUE(line.find("cell (") == 0 || line.find("link ") == 0) << line;
            const auto at = line.find("since cycle ");
            ASSERT_NE(at, std::string::npos) << line;
            const Cycle since = std::stoull(line.substr(at + 12));
            EXPECT_GE(since, before) << "oldest first";
            before = since;
        }
        EXPECT_LE(before, timed->environment().scheduler.now());
    }
    PictureSettings settings;
    MachineSettings machine = estimated_machine();
    std::unique_ptr<PlacedScene> placed;
    std::unique_ptr<Machine> timed;
    RunResult result;
};

}  // namespace raycell
