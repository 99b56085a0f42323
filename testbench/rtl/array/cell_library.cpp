#include "testbench/rtl/array/cell_library.hpp"

#include <dlfcn.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace raycell {
namespace {

namespace fs = std::filesystem;

/// Throws if the cell was verilated for another package: the first line in which they differ.
void expect_package(const std::string& path, const std::string& package) {
    const fs::path folder = fs::absolute(path).parent_path();
    fs::path beside = folder / "raycell_pkg.sv";
    if (!fs::exists(beside)) beside = folder.parent_path() / "raycell_pkg.sv";
    std::ifstream file(beside);
    if (!file)
        throw std::runtime_error(path +
                                 ": no raycell_pkg.sv is beside it or in the folder above; expected "
                                 "the package that the cell was verilated for");
    std::istringstream expected(package);
    std::string is, wanted;
    for (int number = 1; std::getline(expected, wanted); ++number) {
        if (!std::getline(file, is)) is = "(its end)";
        if (is != wanted)
            throw std::runtime_error(path + ": it is a cell of another machine: " + beside.string() + ":" +
                                     std::to_string(number) + ": '" + is + "', expected '" + wanted + "'");
    }
}

template <typename Function>
Function function_of(void* library, const std::string& path, const char* name) {
    void* found = dlsym(library, name);
    if (!found)
        throw std::runtime_error(path + ": it has no function " + name +
                                 "; expected a library of testbench/rtl/render.py");
    return reinterpret_cast<Function>(found);
}

}  // namespace

CellLibrary::CellLibrary(const std::string& path, const std::string& package, int fault) {
    void* library = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library) throw std::runtime_error(path + ": can't be loaded: " + dlerror());
    expect_package(path, package);
    make_ = function_of<rtl::MakeCell>(library, path, rtl::make_cell_name);
    if (!function_of<rtl::PutFault>(library, path, rtl::put_fault_name)(fault))
        throw std::runtime_error(path + ": --rtl-fault " + std::to_string(fault) +
                                 ": this cell was verilated without faults; expected none, or a cell of "
                                 "render.py --faults");
}

}  // namespace raycell
