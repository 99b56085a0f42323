// A cell alone, for tests of its behaviour and counters: the test plays its neighbours.
#pragma once

#include "../truth/hand_made.hpp"
#include "elaboration.hpp"
#include "estimates.hpp"

namespace raycell {

/// Cell (1, 1) of a 3x3 array in the trace phase, with a link to it and one from it on each side.
struct LoneCell {
    explicit LoneCell(const MachineSettings& machine_settings = estimated_machine(),
                      const CellScene& cell_scene = empty(100))
        : scene(cell_scene), machine(machine_settings), picture(3, 3) {
        expect_first_elaboration();
        settings.width = settings.height = 3;
        settings.exterior = ExteriorMode::none;
        environment = std::make_unique<Environment>(scene, settings, machine, scheduler, picture);
        environment->phase = Phase::trace;
        cell = std::make_unique<CellModule>("cell", *environment, 1, 1);
        cell->cell().store() = UntimedMachine(scene, settings, nullptr).cells()[4];
        for (int side = 0; side < side_count; ++side) {
            for (auto* links : {&in, &out}) {
                links->push_back(
                    std::make_unique<Link>(scheduler, environment->classes.count, machine.buffer_depth));
            }
            in.back()->connect_sink(cell->cell());
            out.back()->connect_source(cell->cell());
            cell->in[std::size_t(side)].bind(*in.back());
            cell->out[std::size_t(side)].bind(*out.back());
        }
    }

    static CellScene empty(double depth) {
        CellScene scene = hand_made::cube(3, 3, depth);
        scene.frame.depth_levels = 10;
        return scene;
    }
    Link& from(Side side) { return *in[std::size_t(side)]; }
    Link& towards(Side side) { return *out[std::size_t(side)]; }

    /// Sends a ray over a link that has room; it is visible after `cycles` cycles.
    void send(Link& link, const Ray& ray, int cycles = 1) {
        RayPacket* packet = environment->pools.rays.take();
        packet->ray = ray;
        link.send(environment->classes.ray(ray), Message(packet), cycles);
    }
    void send(Link& link, const Answer& answer, int cycles = 1) {
        Answer* sent = environment->pools.answers.take();
        *sent = answer;
        link.send(environment->classes.answer, Message(sent), cycles);
    }
    /// Removes the ray or answer at the head of a buffer and gives it back to its pool.
    void drop(Link& link, int index) {
        const Message front = link.front(index);
        link.pop(index);
        if (front.kind == Message::Kind::ray) environment->pools.rays.give_back(front.ray);
        if (front.kind == Message::Kind::answer) environment->pools.answers.give_back(front.answer);
    }
    /// Calls `script` in each cycle from 1 to `cycles`, then runs on until nothing moves.
    void run(Cycle cycles, const std::function<void(Cycle)>& script) {
        Actor neighbours("neighbours", scheduler, [&](Cycle now) {
            script(now);
            return now < cycles ? now + 1 : never;
        });
        scheduler.wake(neighbours, 1);
        sc_core::sc_start();
    }

    Scheduler scheduler{"scheduler", sc_core::sc_time(50, sc_core::SC_NS)};
    CellScene scene;
    PictureSettings settings;
    MachineSettings machine = estimated_machine();
    Picture picture;
    std::unique_ptr<Environment> environment;
    std::unique_ptr<CellModule> cell;
    std::vector<std::unique_ptr<Link>> in;
    std::vector<std::unique_ptr<Link>> out;
};

/// A ray as it arrives over a link.
inline Ray lone_ray(const dvec3& position, const dvec3& direction) {
    Ray ray;
    ray.position = position;
    set_direction(ray, direction, exact_arithmetic());
    return ray;
}

}  // namespace raycell
