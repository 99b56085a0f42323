#include "testbench/golden/traversal_recorder.hpp"

#include "testbench/golden/messages.hpp"

namespace raycell {

TraversalRecorder::TraversalRecorder(Machine& machine, const std::vector<Target>& targets,
                                     std::string configuration)
    : environment_(machine.environment()),
      words_(environment_.context.arithmetic),
      packing_(environment_.context, environment_.machine),
      configuration_(std::move(configuration)) {
    for (const Target& target : targets) files_[target.cell] = target.file;
}

/// Writes heads and voxels, which loading has left in the cells.
void TraversalRecorder::begin() {
    if (begun_) return;
    begun_ = true;
    for (const auto& [cell, file] : files_) {
        CellSetup setup;
        setup.machine = environment_.machine;
        setup.x = cell->x();
        setup.y = cell->y();
        for (int side = 0; side < side_count; ++side)
            setup.linked[std::size_t(side)] = cell->input(Side(side)) != nullptr;
        setup.traversal = true;
        std::fputs(setup_text(setup, environment_.context, configuration_).c_str(), file);
        std::fputs(voxel_lines(words_, cell->store()).c_str(), file);
    }
}

void TraversalRecorder::phase_begins(Phase, Cycle) { begin(); }

void TraversalRecorder::cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t,
                                   std::uint32_t) {
    if (event != CellEvent::test) return;
    const auto target = files_.find(&cell);
    if (target == files_.end()) return;
    RayPacket packet = *cell.traversal().packet(cell.traversal().last());
    const Message message(&packet);
    const std::string bits = packing_.packed(message);
    const TraversalSetting setting{cell.store(), environment_.context, environment_.machine, cell.x(),
                                   cell.y()};
    const Cycle done = now + visit_cycles(packet.visit, environment_.settings, environment_.costs());
    std::fprintf(target->second, "%llu test %d %d %s %s ; %s\n%llu found %s\n",
                 static_cast<unsigned long long>(now), packet.ray.fresh, packet.ray.leaves_front,
                 bits.empty() ? no_bits : bits.c_str(), text_of(words_, message).c_str(),
                 remarks_of(message).c_str(), static_cast<unsigned long long>(done),
                 decision_of(words_, setting, packet.ray, packet.visit).c_str());
}

void TraversalRecorder::finish() {
    begin();
    for (const auto& [cell, file] : files_)
        std::fprintf(file, "%llu end\n", static_cast<unsigned long long>(environment_.scheduler.now()));
}

}  // namespace raycell
