#include "testbench/cell/shading_export.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "testbench/cell/hardware_text.hpp"
#include "testbench/cell/shading_files.hpp"
#include "testbench/golden/file.hpp"

namespace raycell {
namespace {

using Word = ShadingMachine::Word;
using Job = ShadingMachine::Job;

constexpr const char* axes = "xyz";
constexpr std::size_t most_waiting = 3;  // so that slots keep their words while others are set up

void add_vector(std::map<std::string, double>& value, const std::string& before, const dvec3& v) {
    for (int i = 0; i < 3; ++i) value[before + axes[i]] = v[i];
}

}  // namespace

ShadingExport::ShadingExport(const CellScene& scene, const PictureSettings& picture,
                             const MachineSettings& machine)
    : context_(scene, picture),
      machine_(machine),
      calls_(context_, machine.costs),
      unit_(calls_, std::size_t(machine.ray_store) + 1, context_.lights.sources.size()) {
    for (std::size_t slot = std::size_t(machine.ray_store); slot-- > 0;) free_.push_back(slot);
}

std::string ShadingExport::hex(Word value) const {
    return " " + MicroImage::hexadecimal(value, calls_.image().register_bits());
}

void ShadingExport::write(ShadeSpace space, std::size_t number, const std::vector<Word>& words) {
    unit_.write(space, number, words);
    for (std::size_t i = 0; i < words.size(); ++i)
        text_ += "m " + std::to_string(int(space)) + " " + std::to_string(number * words.size() + i) +
                 hex(words[i]) + "\n";
}

void ShadingExport::cell(const CellStore& store, int x, int y) {
    finish();
    store_ = &store;
    x_ = x;
    y_ = y;
    voxels_most_ = std::max(voxels_most_, store.voxels.size());
    const auto words = [&](ShadeSpace space, const std::string& before,
                           const std::map<std::string, double>& value) {
        std::vector<Word> all;
        for (const std::string& name : calls_.words(space))
            all.push_back(calls_.word(before + name, value.at(name)));
        return all;
    };
    if (text_.empty()) {
        const Operators operators(context_.settings.numbers.operators, context_.settings.numbers.word_bits,
                                  context_.settings.numbers.rounding);
        for (std::size_t i = 0; i < context_.objects.size(); ++i) {
            const Material& m = context_.objects[i];
            std::map<std::string, double> value = {{"mirror", mirror_share(m)},
                                                   {"transmit", transmit_share(m)},
                                                   {"ior", m.ior},
                                                   {"kd", m.diffuse},
                                                   {"ks", m.specular},
                                                   {"shine", operators.exponent_word().hold(m.shine)}};
            add_vector(value, "c", m.colour);
            write(ShadeSpace::object, i, words(ShadeSpace::object, "object ", value));
        }
        for (std::size_t i = 0; i < context_.lights.sources.size(); ++i) {
            const Source& s = context_.lights.sources[i];
            const int exponent = context_.arithmetic.formats().place_exponent(s.position);
            std::map<std::string, double> value = {{"exponent", exponent}};
            for (int a = 0; a < 3; ++a)
                value[std::string("s") + axes[a]] = std::ldexp(s.position[a], -exponent);
            add_vector(value, "i", s.intensity);
            write(ShadeSpace::source, i, words(ShadeSpace::source, "source ", value));
        }
    }
    for (std::size_t i = 0; i < store.voxels.size(); ++i) {
        const Voxel& v = store.voxels[i];
        std::map<std::string, double> value = {{"object", v.object},
                                               {"polygon", v.polygon},
                                               {"near", v.near},
                                               {"drop x", v.drop == 0},
                                               {"drop z", v.drop == 2}};
        add_vector(value, "g", v.plane.n);
        add_vector(value, "b", v.normal.base);
        add_vector(value, "u", v.normal.du);
        add_vector(value, "v", v.normal.dv);
        write(ShadeSpace::voxel, i, words(ShadeSpace::voxel, "voxel ", value));
    }
}

void ShadingExport::set_ray(const Ray& ray, const CellHit& hit) {
    std::map<std::string, double> value = {
        {"weight", ray.weight}, {"generation", ray.generation}, {"t", hit.t}};
    add_vector(value, "", ray.position);
    add_vector(value, "d", ray.direction);
    for (const std::string& name : shading_ray_words()) {
        const Word word = calls_.word("setup." + name, value.at(name));
        unit_.set(name, word);
        text_ += "f " + std::to_string(calls_.number(calls_.place("setup." + name))) + hex(word) + "\n";
    }
}

ShadingMachine::Input ShadingExport::input(Job job, std::size_t slot, std::uint32_t voxel) const {
    ShadingMachine::Input in;
    in.job = job;
    in.slot = slot;
    in.voxel = voxel;
    in.ports.assign(calls_.words(ShadeSpace::port).size(), 0);
    in.ports[calls_.place("port x").number] = x_;
    in.ports[calls_.place("port y").number] = y_;
    return in;
}

ShadingMachine::Result ShadingExport::run(const ShadingMachine::Input& in) {
    const auto number = [](std::uint64_t n) { return " " + std::to_string(n); };
    text_ += "j" + number(std::uint64_t(in.job)) + number(in.slot) + number(in.voxel) +
             number(std::uint64_t(x_)) + number(std::uint64_t(y_)) + number(in.lit);
    for (const char* side : {"reflected ", "refracted "}) {
        for (int i = 0; i < 3; ++i)
            text_ += hex(in.ports[calls_.place(std::string("port ") + side + axes[i]).number]);
    }
    const ShadingMachine::Result result = unit_.run(in);
    text_ += "\n";
    const auto add_outs = [&](const std::vector<Word>& outs, const std::vector<std::string>& names) {
        for (const std::string& name : names) text_ += hex(outs[calls_.place("out " + name).number]);
    };
    for (const ShadingMachine::Child& child : result.children) {
        text_ += "c" + number(child.number);
        add_outs(child.words, shading_child_words());
        text_ += "\n";
    }
    text_ +=
        "d" + number(result.facing) + number(result.charge) + number(result.cycles) + number(result.copies);
    add_outs(unit_.outs(), shading_result_words());
    text_ += "\n";
    ++jobs_;
    cycles_ += result.cycles;
    copies_ += result.copies;
    charged_ += result.charge;
    return result;
}

void ShadingExport::same(const std::string& what, Word is, Word wanted) const {
    if (is == wanted) return;
    throw GoldenError("cell (" + std::to_string(x_) + ", " + std::to_string(y_) + "), hit " +
                      std::to_string(hits_) + ": the shading programs' " + what + " is " +
                      std::to_string(std::int64_t(is)) + ", expected " +
                      std::to_string(std::int64_t(wanted)));
}

void ShadingExport::same_word(const std::string& name, double wanted) const {
    same(name, unit_.out(name), calls_.word("out " + name, wanted));
}

void ShadingExport::check_child(const ShadingMachine::Child& child, std::size_t number, const Ray& ray) {
    same("child", Word(child.number), Word(number));
    std::map<std::string, double> wanted;
    add_vector(wanted, "", ray.position);
    add_vector(wanted, "d", ray.direction);
    int exponent = 0;
    wanted["mx"] = std::frexp(std::abs(ray.inverse_x), &exponent);
    wanted["ex"] = exponent;
    wanted["my"] = std::frexp(std::abs(ray.inverse_y), &exponent);
    wanted["ey"] = exponent;
    wanted["front"] = ray.leaves_front;
    if (is_shadow(ray.kind)) {
        wanted["reach"] = std::isinf(ray.reach) ? context_.arithmetic.formats().reach.most() : ray.reach;
    } else {
        wanted["weight"] = ray.weight;
    }
    for (const auto& [name, value] : wanted)
        same("child's " + name, child.words[calls_.place("out " + name).number],
             calls_.word("out " + name, value));
}

void ShadingExport::check_setup(const ShadingMachine::Result& result, const Waiting& w) {
    const Voxel& voxel = store_->voxels[w.hit.voxel];
    same("facing lights", Word(result.facing), Word(w.setup.facing));
    same_word("reflects", w.setup.reflects);
    same_word("refracts", w.setup.refracts);
    same_word("polygon", voxel.polygon);
    same_word("object", voxel.object);
    same("setup's charge", result.charge, setup_cycles(context_, w.setup, machine_.costs));
    std::size_t next = 0;
    const auto child = [&](std::size_t number, const Ray& ray) {
        same("children", Word(result.children.size()) > Word(next), 1);
        check_child(result.children[next++], number, ray);
    };
    const std::size_t lights = context_.lights.sources.size();
    for (std::size_t light = 0; light < lights; ++light) {
        if (w.setup.facing >> light & 1)
            child(light, shadow_ray(context_, *store_, w.ray, w.hit, w.setup, light, x_, y_));
    }
    const std::size_t secondary = std::max<std::size_t>(lights, 1);
    if (w.setup.reflects) child(secondary, reflected_ray(context_, *store_, w.ray, w.hit, w.setup, x_, y_));
    if (w.setup.refracts)
        child(secondary + 1, refracted_ray(context_, *store_, w.ray, w.hit, w.setup, x_, y_));
    same("number of children", Word(result.children.size()), Word(next));
}

void ShadingExport::check_colour(const dvec3& wanted) {
    same_word("red", wanted.x);
    same_word("green", wanted.y);
    same_word("blue", wanted.z);
}

void ShadingExport::hit(const Ray& ray, const CellHit& hit) {
    ++hits_;
    const std::uint32_t object = store_->voxels[hit.voxel].object;
    Waiting w{ray, hit, set_up_hit(context_, *store_, ray, hit, x_, y_), 0, object};
    if (random_() % 4 == 0) {
        set_ray(ray, hit);
        const auto result = run(input(Job::direct, std::size_t(machine_.ray_store), hit.voxel));
        check_colour(shade_hit(context_, w.setup, object, 0, dvec3(0), dvec3(0)));
        same("charge of a hit that waits for nothing", result.charge,
             setup_cycles(context_, w.setup, machine_.costs) +
                 shade_cycles(context_, w.setup, object, 0, false, machine_.costs));
    }
    if (waiting_.size() == most_waiting || free_.empty()) shade(random_() % waiting_.size());
    w.slot = free_.back();
    free_.pop_back();
    set_ray(ray, hit);
    check_setup(run(input(Job::set_up, w.slot, hit.voxel)), w);
    waiting_.push_back(w);
}

void ShadingExport::shade(std::size_t which) {
    const Waiting w = waiting_[which];
    waiting_.erase(waiting_.begin() + std::ptrdiff_t(which));
    free_.insert(free_.begin(), w.slot);
    ShadingMachine::Input in = input(Job::shade, w.slot, w.hit.voxel);
    in.lit = w.setup.facing & random_();
    const Format& word = context_.arithmetic.formats().intensity;
    std::uniform_real_distribution<double> any(0, 1);
    const auto answer = [&](bool sent, const std::string& name) {
        dvec3 colour(0);
        for (int i = 0; sent && i < 3; ++i) {
            colour[i] = word.hold(any(random_) * (random_() % 8 == 0 ? word.most() : 1));
            const std::string place = "port " + name + axes[i];
            in.ports[calls_.place(place).number] = calls_.word(place, colour[i]);
        }
        return colour;
    };
    const dvec3 reflected = answer(w.setup.reflects, "reflected ");
    const dvec3 refracted = answer(w.setup.refracts, "refracted ");
    const ShadingMachine::Result result = run(in);
    check_colour(shade_hit(context_, w.setup, w.object, in.lit, reflected, refracted));
    same_word("object", w.object);
    same("shading's charge", result.charge,
         shade_cycles(context_, w.setup, w.object, in.lit, true, machine_.costs));
}

void ShadingExport::finish() {
    while (!waiting_.empty()) shade(0);
}

std::vector<std::pair<std::string, std::string>> ShadingExport::files() const {
    ShadingSizes sizes;
    sizes.slots = std::size_t(machine_.ray_store) + 1;
    sizes.voxels = voxels_most_;
    sizes.objects = std::max<std::size_t>(context_.objects.size(), 1);
    sizes.sources = std::max<std::size_t>(context_.lights.sources.size(), 1);
    sizes.cells = std::size_t(std::max(context_.scene.frame.width, context_.scene.frame.height));
    auto files = shading_files(calls_, sizes);
    files.emplace_back("shading_jobs.txt", text_);
    files.emplace_back("shading_lights.txt", std::to_string(context_.lights.sources.size()) + "\n");
    return files;
}

std::string ShadingExport::said() const {
    std::ostringstream text;
    text << hits_ << " hits, " << jobs_ << " jobs of the shading unit; the programs take " << cycles_
         << " cycles, the cost table says " << charged_ << ", and " << copies_ << " copies\n";
    return text.str();
}

}  // namespace raycell
