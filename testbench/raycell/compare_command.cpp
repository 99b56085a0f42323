// raycell compare: how far a picture is from another, as text or JSON, and the picture of the difference.
#include <cstdio>
#include <iostream>

#include "testbench/common/new_file.hpp"
#include "testbench/common/options.hpp"
#include "testbench/common/picture_file.hpp"
#include "testbench/common/report_json.hpp"
#include "testbench/common/scene_input.hpp"
#include "testbench/raycell/commands.hpp"

namespace raycell {
namespace {

struct CompareOptions {
    std::string test;
    std::string truth;
    std::string difference;
    double gain = 8;
    double least_psnr = 0;
    double most_wrong_hits = 100;
    bool json = false;
};

bool is_png(const std::string& path) { return path.size() > 4 && path.substr(path.size() - 4) == ".png"; }

int run(const CompareOptions& options) {
    bool hits_known = true;
    const auto read = [&](const std::string& path) {
        std::vector<std::string> absent;
        if (is_png(path)) {
            hits_known = false;
            return read_png(path);
        }
        Picture picture = read_exr(path, &absent);
        for (const std::string& channel : absent) hits_known = hits_known && channel != "polygon";
        return picture;
    };
    OutputSet outputs(options.difference);
    if (!options.difference.empty()) {
        for (const std::string& input : {options.test, options.truth}) {
            if (same_file(options.difference, input))
                throw UsageError("--output " + options.difference +
                                 ": it would be overwritten, but is to be compared; expected another name");
        }
        check_place("--output", options.difference);
        outputs.announce({""});
    }
    const Picture test = read(options.test);
    const Picture truth = read(options.truth);
    auto json = report(test, truth);
    if (!options.difference.empty()) {
        outputs.write("", [&](NewFile& file) { write_png(difference(test, truth, options.gain), file); });
        outputs.publish();
    }
    const auto value = [&](const char* name) { return json.at(name).get<double>(); };
    const bool passed = value("psnr_db") >= options.least_psnr &&
                        (!hits_known || value("wrong_hit_percent") <= options.most_wrong_hits);
    if (options.json) {
        if (!hits_known) json["wrong_hit_percent"] = nullptr;
        std::cout << json.dump(2) << '\n';
        return passed ? exit_done : exit_comparison;
    }
    std::printf("PSNR                        %8.2f dB\n", value("psnr_db"));
    std::printf("RMSE                        %8.5f\n", value("rmse"));
    std::printf("largest error               %8.5f\n", value("max_error"));
    std::printf("pixels off by over 1/255    %8.3f %%\n", value("off_by_1_255_percent"));
    std::printf("pixels off by over 0.1      %8.3f %%\n", value("off_by_0_1_percent"));
    std::printf("SSIM                        %8.5f    values as the PNG has them\n", value("ssim"));
    std::printf("FLIP                        %8.5f    values as sRGB, 67 pixels per degree\n", value("flip"));
    std::printf("relative MSE                %8.5f    intensities, no transfer curve\n",
                value("relative_mse"));
    if (hits_known) std::printf("pixels that hit elsewhere   %8.3f %%\n", value("wrong_hit_percent"));
    return passed ? exit_done : exit_comparison;
}

}  // namespace

Command add_compare_command(CLI::App& program) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App* app = program.add_subcommand("compare",
                                           "Compares two pictures, .exr or .png; exit code 2 if they "
                                           "differ by more than was allowed");
    app->add_option("picture", options->test, "the picture in question")->required()->type_name("FILE");
    app->add_option("truth", options->truth, "what it is compared with")->required()->type_name("FILE");
    app->add_option("-o,--output", options->difference, "write the difference as PNG")->type_name("FILE");
    OptionTable table(*app);
    table.number("gain", options->gain, 0.0, 1000.0, "the difference is multiplied by this in the PNG");
    table.number("psnr", options->least_psnr, 0.0, 200.0, "least PSNR that passes, dB");
    table.number("wrong-hits", options->most_wrong_hits, 0.0, 100.0,
                 "most pixels with another first hit, percent");
    table.flag("json", options->json, "print JSON");
    return {app, [options] { return run(*options); }};
}

}  // namespace raycell
