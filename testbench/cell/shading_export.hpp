// Jobs of the shading unit as files for hardware: programs, calls, script, memories, jobs.
#pragma once

#include <random>
#include <string>
#include <utility>
#include <vector>

#include "model/tracing/tracing.hpp"
#include "testbench/cell/shading_machine.hpp"

namespace raycell {

/// Sets up and shades the hits of a run by the microprograms, as the hardware calls them, and compares with
/// the model. Which lights are lit and what children answer is drawn.
class ShadingExport {
  public:
    /// All arguments must outlive it. Throws std::invalid_argument for a machine whose shading the unit does
    /// not have.
    ShadingExport(const CellScene& scene, const PictureSettings& picture, const MachineSettings& machine);

    MicroImage& image() { return calls_.image(); }
    /// The next cell: hits until the next one are in it. Throws GoldenError as hit() does.
    void cell(const CellStore& store, int x, int y);
    /// Throws GoldenError where the microprograms differ from the model.
    void hit(const Ray& ray, const CellHit& hit);
    /// Ends the last cell.
    void finish();
    /// Names and texts. The image must have had its widths before the first cell.
    std::vector<std::pair<std::string, std::string>> files() const;
    /// A line that says what was written.
    std::string said() const;

  private:
    /// A hit in a slot, which waits.
    struct Waiting {
        Ray ray;
        CellHit hit;
        HitSetup setup;
        std::size_t slot;
        std::uint32_t object;  ///< the store may be gone when it is shaded
    };
    void set_ray(const Ray& ray, const CellHit& hit);
    ShadingMachine::Input input(ShadingMachine::Job job, std::size_t slot, std::uint32_t voxel) const;
    /// Runs a job and writes it down.
    ShadingMachine::Result run(const ShadingMachine::Input& input);
    void check_setup(const ShadingMachine::Result& result, const Waiting& waiting);
    void check_child(const ShadingMachine::Child& child, std::size_t number, const Ray& ray);
    void shade(std::size_t which);
    void check_colour(const dvec3& wanted);
    void same(const std::string& what, ShadingMachine::Word is, ShadingMachine::Word wanted) const;
    /// `name`: of an output.
    void same_word(const std::string& name, double wanted) const;
    void write(ShadeSpace space, std::size_t number, const std::vector<ShadingMachine::Word>& words);
    std::string hex(ShadingMachine::Word value) const;

    Context context_;
    const MachineSettings& machine_;
    ShadingCalls calls_;
    ShadingMachine unit_;
    std::mt19937_64 random_{1};
    const CellStore* store_ = nullptr;
    int x_ = 0, y_ = 0;
    std::vector<Waiting> waiting_;
    std::vector<std::size_t> free_;
    std::string text_;  ///< of the jobs' file
    std::size_t voxels_most_ = 1, jobs_ = 0, hits_ = 0;
    std::uint64_t cycles_ = 0, charged_ = 0, copies_ = 0;
};

}  // namespace raycell
