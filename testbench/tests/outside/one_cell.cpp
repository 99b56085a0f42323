// One cell between two links, outside any array: a ray comes in from the west and leaves to the east.
#include <cells/hosts/cell_module.hpp>
#include <iostream>

using namespace raycell;

int sc_main(int, char**) {
    CellScene scene;
    scene.frame.width = scene.frame.height = 3;
    scene.frame.depth = 100;
    scene.frame.viewer_at_infinity = true;
    PictureSettings settings;
    settings.width = settings.height = 3;
    settings.exterior = ExteriorMode::none;
    const MachineSettings machine;
    Picture picture(3, 3);
    Scheduler scheduler("scheduler", sc_core::sc_time(50, sc_core::SC_NS));
    Environment environment(scene, settings, machine, scheduler, picture);
    environment.phase = Phase::trace;

    CellModule cell("cell", environment, 1, 1);
    Link west(scheduler, environment.classes.count, machine.buffer_depth);
    Link east(scheduler, environment.classes.count, machine.buffer_depth);
    west.connect_sink(cell.cell());
    east.connect_source(cell.cell());
    cell.in[int(Side::west)].bind(west);
    cell.out[int(Side::east)].bind(east);

    RayPacket* ray = environment.pools.rays.take();
    ray->ray.position = {0, 0.5, 5};
    set_direction(ray->ray, {1, 0, 0}, environment.context.arithmetic);
    const int index = environment.classes.ray(ray->ray);
    west.send(index, Message(ray), 1);
    sc_core::sc_start();
    if (east.occupancy(index) != 1) return 1;
    std::cout << "left to the east, there in cycle " << east.arrival(index) << '\n';
    return 0;
}
