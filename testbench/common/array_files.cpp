#include "testbench/common/array_files.hpp"

#include <cerrno>
#include <cstring>
#include <iostream>
#include <memory>

#include "model/files/array_check.hpp"
#include "model/files/input_file.hpp"
#include "testbench/common/new_file.hpp"

namespace raycell {
namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

LoadedArray read(const std::string& path) {
    std::string fault = input_fault(path);
    const std::unique_ptr<std::FILE, Closer> file(fault.empty() ? std::fopen(path.c_str(), "rb") : nullptr);
    if (fault.empty() && !file) fault = std::string("can't be opened: ") + std::strerror(errno);
    if (!fault.empty())
        throw UsageError("--load-array: " + path + ": " + fault + "; expected a file of --save-array");
    return read_array(file.get(), "--load-array: " + path);
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
    if (!options.save_array.empty() && !options.load_array.empty())
        throw UsageError("--save-array: the array of --load-array is kept already; expected one of the two");
}

ArrayFiles::ArrayFiles(const RenderOptions& options, const CellScene& scene) : save_(options.save_array) {
    if (options.load_array.empty()) return;
    LoadedArray array = read(options.load_array);
    const auto cells = std::size_t(options.picture.width) * std::size_t(options.picture.height);
    if (array.cells.size() != cells)
        throw UsageError("--load-array: " + options.load_array + ": holds " +
                         std::to_string(array.cells.size()) + " cells; expected " + std::to_string(cells) +
                         ", as many as --cells asks for");
    if (array.key != loading_key(scene, options.picture))
        throw UsageError("--load-array: " + options.load_array +
                         ": is of another scene, view or size, or was loaded with other voxels or words; "
                         "expected the scene and the settings that it was saved with");
    check_array(array, scene, options.picture, "--load-array: " + options.load_array);
    if (array.timing != loading_timing(options.machine))
        std::cerr << options.load_array
                  << ": warning: it was loaded with other buffers, links or costs: cycles and hash of the "
                     "loading are those of that machine\n";
    loaded_ = std::move(array);
}

void ArrayFiles::attach(Machine& machine, OutputSet& outputs) {
    if (loaded_) machine.use_loaded(std::move(*loaded_));
    if (save_.empty()) return;
    machine.set_on_loaded([path = save_, &outputs](const LoadedArray& array) {
        NewFile& file = outputs.begin_file(path);
        write_array(file.stream(), array);
        file.close();
    });
}

}  // namespace raycell
