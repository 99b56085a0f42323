#include "testbench/rtl/whole_files.hpp"

#include <algorithm>
#include <stdexcept>

#include "testbench/cell/load_files.hpp"
#include "testbench/cell/shading_files.hpp"
#include "testbench/cell/visit_files.hpp"
#include "testbench/common/new_file.hpp"

namespace raycell {
namespace {

constexpr int most_voxels = 1 << 14;

void check(const Context& context, const MachineSettings& machine, const WholeSizes& sizes) {
    const auto refuse = [](const std::string& what, const std::string& expected) {
        throw std::invalid_argument("the whole cell in SystemVerilog has no " + what + "; expected " +
                                    expected);
    };
    if (context.lights.sources.empty()) refuse("scene without sources", "one with sources");
    if (machine.slots != Slots::reserved) refuse("other division of its slots", "--slots reserved");
    if (machine.recovery != Recovery::postpone) refuse("other recovery", "--recovery postpone");
    if (machine.load_queue != 0) refuse("limit on spans that wait", "--load-queue 0");
    if (sizes.voxels < 2 || sizes.voxels > most_voxels || sizes.edges < 1)
        refuse("memory of that size", "2 to " + std::to_string(most_voxels) + " voxels, an edge at least");
}

}  // namespace

std::vector<std::pair<std::string, std::string>> whole_files(const Context& context,
                                                             const MachineSettings& machine,
                                                             const WholeSizes& sizes) {
    check(context, machine, sizes);
    const VisitCalls visit(context);
    ShadingCalls shading(context, machine.costs);
    const LoadCalls load(context);
    MicroImage visit_image = image_of(visit);
    MicroImage load_image = image_of({&load.unit()});
    MicroImage::share({&visit_image, &shading.image(), &load_image});

    const auto voxels = std::size_t(sizes.voxels);
    const auto edges = std::size_t(sizes.edges);
    ShadingSizes shades;
    shades.slots = std::size_t(machine.ray_store) + 1;
    shades.voxels = voxels;
    shades.objects = std::max<std::size_t>(context.objects.size(), 1);
    shades.sources = context.lights.sources.size();
    shades.cells = std::size_t(std::max(context.scene.frame.width, context.scene.frame.height));

    const std::size_t store = voxels * visit.voxel_fields().size() + edges * (visit.edge_fields().size() + 1);
    LoadSizes loads;
    loads.memories = {voxels * load.voxel_stride(), edges * load.edge_stride(), voxels * load.table_stride()};
    loads.ports = {store, voxels * load.voxel_words().size(), shades.objects * load.object_words().size(),
                   shades.sources * load.source_words().size()};

    const VisitFiles visits = visit_files(visit, visit_image, store, context.settings.hit == HitTest::edge);
    std::vector<std::pair<std::string, std::string>> files = {
        {"microcode.sv", visit_image.package()},
        {"visit.sv", visits.package},
        {"programs.hex", visit_image.instruction_file()},
        {"tables.hex", visit_image.table_file()},
        {"registers.hex", visit_image.register_file()},
        {"copies.hex", visits.copies},
        {"calls.hex", visits.calls}};
    for (auto& file : shading_files(shading, shades)) files.push_back(std::move(file));
    for (auto& file : load_files(load, load_image, loads)) files.push_back(std::move(file));
    return files;
}

void write_units(const std::string& folder, const std::vector<std::pair<std::string, std::string>>& files) {
    OutputSet set(folder + "/");
    std::vector<std::string> names;
    for (const auto& [name, text] : files) names.push_back(name);
    set.announce(names);
    for (const auto& [name, text] : files) set.write(name, text);
    set.publish();
}

}  // namespace raycell
