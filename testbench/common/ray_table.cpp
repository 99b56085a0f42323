#include "testbench/common/ray_table.hpp"

namespace raycell {

void RayTable::launched(const Cell& cell, Cycle now, const Ray& ray, const Ray* parent) {
    if (!lives_.again(ray.id)) lives_.add(cell, now, ray, parent);
}

void RayTable::cell_event(const Cell& cell, Cycle now, CellEvent event, std::uint64_t ray,
                          std::uint32_t detail) {
    if (event == CellEvent::load) return;
    if (RayLife* life = lives_.find(ray)) RayLives::note(*life, cell, now, event, detail);
}

void RayTable::stalled(const Cell& /*cell*/, Cycle /*now*/, std::uint64_t ray, Stall cause, Cycle cycles) {
    if (RayLife* life = lives_.find(ray)) life->waited[std::size_t(cause)] += cycles;
}

void RayTable::exterior_answered(int /*x*/, int /*y*/, Cycle /*now*/, const Answer& answer) {
    if (RayLife* life = lives_.find(answer.id)) RayLives::from_exterior(*life);
}

void RayTable::exterior_silent(Cycle now, std::uint64_t ray) {
    if (RayLife* life = lives_.find(ray)) RayLives::silent_outside(*life, now);
}

std::string RayTable::csv() const {
    std::string text =
        "ray,parent,kind,generation,home_x,home_y,end,end_x,end_y,launched,ended,hops,answer_hops,waited,"
        "postponed\n";
    for (const std::size_t index : lives_.in_order()) {
        const RayLife& life = lives_.all()[index];
        const auto field = [&](const std::string& value) { text += value + ","; };
        field(ray_name(life.id));
        field(life.parent == RayLife::no_parent ? "" : ray_name(lives_.all()[life.parent].id));
        field(ray_kind_names[std::size_t(life.kind)]);
        field(std::to_string(life.generation));
        field(std::to_string(life.x));
        field(std::to_string(life.y));
        field(end_names[std::size_t(life.end)]);
        field(std::to_string(life.last_x));
        field(std::to_string(life.last_y));
        field(std::to_string(life.launched));
        field(life.ended == never ? "" : std::to_string(life.ended));
        field(std::to_string(life.ray_hops));
        field(std::to_string(life.answer_hops));
        field(std::to_string(life.waited_in_all()));
        text += std::to_string(life.postponed) + "\n";
    }
    return text;
}

}  // namespace raycell
