#include "testbench/raycell/array_files.hpp"

#include <memory>

#include "model/array_file.hpp"
#include "testbench/raycell/new_file.hpp"

namespace raycell {
namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

LoadedArray read(const std::string& path) {
    const std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "rb"));
    if (!file) throw UsageError("--load-array: " + path + ": can't be read; expected a file of --save-array");
    return read_array(file.get(), path);
}

}  // namespace

void check_arrays(const RenderOptions& options) {
    for (const auto& [name, path] :
         {std::pair{"--save-array", &options.save_array}, {"--load-array", &options.load_array}}) {
        if (path->empty()) continue;
        if (options.engine == Engine::untimed)
            throw UsageError(std::string(name) +
                             ": the untimed engine loads in no time; expected --engine timed");
        if (options.machine.stall > 0)
            throw UsageError(std::string(name) +
                             ": the draws of --stall go on through a run; expected --stall 0");
        if (!options.golden.empty())
            throw UsageError(std::string(name) +
                             ": golden vectors begin with loading; expected no --golden beside it");
    }
}

ArrayFiles::ArrayFiles(const RenderOptions& options, const CellScene& scene, Machine& machine) {
    if (!options.load_array.empty()) {
        LoadedArray array = read(options.load_array);
        const auto cells = std::size_t(options.picture.width) * std::size_t(options.picture.height);
        if (array.cells.size() != cells ||
            array.key != loading_key(scene, options.picture, options.machine)) {
            throw UsageError(
                "--load-array: " + options.load_array +
                ": is of another scene, view or size, or was loaded with other voxels, words, buffers, links "
                "or costs; expected the settings that it was saved with");
        }
        machine.use_loaded(std::move(array));
    }
    if (options.save_array.empty()) return;
    machine.set_on_loaded([path = options.save_array](const LoadedArray& array) {
        NewFile file(path);
        write_array(file.stream(), array);
        file.finish();
    });
}

}  // namespace raycell
