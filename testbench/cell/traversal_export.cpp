#include "testbench/cell/traversal_export.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "testbench/cell/hardware_text.hpp"
#include "testbench/cell/shading_export.hpp"
#include "testbench/cell/visit_calls.hpp"
#include "testbench/cell/visit_files.hpp"
#include "testbench/common/new_file.hpp"

namespace raycell {
namespace {

using Word = MicroMachine::Value;

/// A visit by microprograms, call by call: what traversal.sv does.
class MicroVisit {
  public:
    MicroVisit(const VisitCalls& calls, const Context& context) : calls_(calls), context_(context) {
        for (const auto& program : calls.programs()) machines_.emplace_back(*program);
        words_.assign(calls.fields().size(), 0);
    }

    /// The voxels in the order of the index table, then the edges.
    void take(const CellStore& store) {
        store_.clear();
        const std::size_t stride = calls_.voxel_fields().size();
        const std::size_t edge_stride = calls_.edge_fields().size() + 1;
        const std::size_t edges = stride * store.index.size();
        lines_ = store.index.size();
        for (const IndexEntry& line : store.index) {
            const Voxel& v = store.voxels[line.voxel];
            const std::map<std::string, double> value = {
                {"number", line.voxel},
                {"polygon", v.polygon},
                {"near", v.near},
                {"far", v.far},
                {"most", line.most},
                {"nx", v.plane.n.x},
                {"ny", v.plane.n.y},
                {"nz", v.plane.n.z},
                {"c", v.plane.c},
                {"drop x", v.drop == 0},
                {"drop z", v.drop == 2},
                {"edges", v.pieces ? v.edge_count : 0},
                {"first", double(edges + v.first_edge * edge_stride)}};
            for (const std::string& name : calls_.voxel_fields())
                store_.push_back(calls_.word(ValueSpace::voxel, name, value.at(name)));
        }
        for (const EdgeFunction& e : store.edges) {
            const std::map<std::string, double> value = {{"a", e.a}, {"b", e.b}, {"c", e.c}};
            for (const std::string& name : calls_.edge_fields())
                store_.push_back(calls_.word(ValueSpace::edge, name, value.at(name)));
            store_.push_back(e.piece);
        }
    }

    enum class Event { forward, hit, leaves, source };
    struct Result {
        Event event;
        std::size_t runs = 0, tests = 0, edges = 0;
        std::uint64_t charged = 0, cycles = 0, copies = 0;  ///< of programs in the cost table; of all
    };

    void take(const Ray& ray) {
        const auto put = [&](const char* name, double v) {
            set(name, calls_.word(ValueSpace::field, name, v));
        };
        const double reach = context_.arithmetic.formats().reach.most();
        put("x", ray.position.x);
        put("y", ray.position.y);
        put("z", ray.position.z);
        put("dx", ray.direction.x);
        put("dy", ray.direction.y);
        put("dz", ray.direction.z);
        put("reach", std::isinf(ray.reach) ? reach : ray.reach);
        int exponent = 0;
        put("mx", std::frexp(std::abs(ray.inverse_x), &exponent));
        put("ex", exponent);
        put("my", std::frexp(std::abs(ray.inverse_y), &exponent));
        put("ey", exponent);
        if (context_.settings.hit == HitTest::edge) put("leaves", ray.fresh && ray.leaves != no_polygon);
        put("polygon left", ray.leaves == no_polygon ? -1 : double(ray.leaves));
        finite_ = !std::isinf(ray.reach);
        shadow_ = is_shadow(ray.kind);
        outside_ = ray.outside;
    }

    Result visit() {
        result_ = {};
        result_.event = Event::forward;
        call("walk");
        if (outside_) return result_;
        set("axial", get("flags") == 2);
        if (get("flags") != 0) {
            call("leave");
            result_.event = Event::leaves;
        }
        if (finite_ && get("left") <= 0) {
            call("reached");
            result_.event = Event::source;
        }
        call("range");
        bool found = false;
        Word best_polygon = 0;
        const bool inwards = get("dz") >= 0;
        for (std::size_t i = 0; i < lines_; ++i) {
            line_ = (inwards ? i : lines_ - 1 - i) * calls_.voxel_fields().size();
            ++result_.runs;
            call(inwards ? "run" : "run outwards");
            if (get("meets") == 2) break;
            if (get("meets") == 0 || get("polygon") == get("polygon left")) continue;
            ++result_.tests;
            call("test");
            if (get("hit") == 0 || !inside()) continue;
            set("lower", found && get("polygon") < best_polygon);
            if (found) {
                call("nearer");
                if (get("nearer") == 0) continue;
            }
            found = true;
            best_polygon = get("polygon");
            best_number_ = get("number");
            set("best", get("hit t"));
            call("narrow");
        }
        if (found && shadow_ && finite_) {
            call("at source");
            if (get("there") != 0) found = false;
        }
        if (found) result_.event = Event::hit;
        return result_;
    }

    Word get(const std::string& name) const { return words_[calls_.field(name)]; }
    Word number() const { return best_number_; }
    const std::vector<Word>& words() const { return words_; }
    const std::vector<Word>& store() const { return store_; }
    std::size_t lines() const { return lines_; }
    bool shadow() const { return shadow_; }
    bool finite() const { return finite_; }
    bool outside() const { return outside_; }

  private:
    void set(const std::string& name, Word value) { words_[calls_.field(name)] = value; }

    void call(const std::string& name) {
        const VisitCall& c = calls_.calls()[calls_.call(name)];
        MicroMachine& machine = machines_[c.program];
        for (const Transfer& t : c.loads) {
            const Word value = t.space == ValueSpace::field   ? words_[t.from]
                               : t.space == ValueSpace::voxel ? store_[line_ + t.from]
                                                              : store_[edge_ + t.from];
            if (t.to_field) {
                words_[t.to] = value;
            } else {
                machine.set(t.to, std::int64_t(value));
            }
        }
        const int cycles = machine.run();
        result_.cycles += std::uint64_t(cycles);
        if (c.charged) result_.charged += std::uint64_t(cycles);
        result_.copies += c.loads.size() + c.stores.size();
        for (const auto& [from, to] : c.stores) words_[to] = machine.values()[from];
    }

    /// Whether the point is inside all edges of one of the voxel's pieces; no more of them are computed than
    /// it takes to know.
    bool inside() {
        if (context_.settings.hit != HitTest::edge || get("edges") == 0) return true;
        call("projection");
        const std::size_t stride = calls_.edge_fields().size() + 1;
        edge_ = std::size_t(get("first"));
        bool all = true;
        Word piece = store_[edge_ + stride - 1];
        for (Word left = get("edges"); left > 0; --left, edge_ += stride) {
            const Word now = store_[edge_ + stride - 1];
            if (now != piece) {
                if (all) return true;
                all = true;
                piece = now;
            }
            if (!all) continue;
            ++result_.edges;
            call("edge");
            all = get("inside") != 0;
        }
        return all;
    }

    const VisitCalls& calls_;
    const Context& context_;
    std::vector<MicroMachine> machines_;
    std::vector<Word> words_, store_;
    std::size_t lines_ = 0, line_ = 0, edge_ = 0;
    bool finite_ = false, shadow_ = false, outside_ = false;
    Word best_number_ = 0;
    Result result_;
};

/// Throws GoldenError where the microprograms differ from the model's visit.
void check(const MicroVisit& micro, const MicroVisit::Result& result, const VisitCalls& calls, const Ray& ray,
           const Visit& visit, const Context& context) {
    const auto same = [&](const char* name, double wanted) {
        const Word word = calls.word(ValueSpace::field, name, wanted);
        if (micro.get(name) != word)
            throw GoldenError(std::string("the microprograms' ") + name + " is " +
                              std::to_string(std::int64_t(micro.get(name))) + ", expected " +
                              std::to_string(std::int64_t(word)));
    };
    using Event = MicroVisit::Event;
    const Event events[] = {Event::hit, Event::forward, Event::leaves, Event::source};
    if (result.event != events[int(visit.event)])
        throw GoldenError("the microprograms' event is " + std::to_string(int(result.event)) + ", expected " +
                          std::to_string(int(events[int(visit.event)])));
    if (result.runs != visit.comparisons.runs || result.tests != visit.comparisons.tests)
        throw GoldenError("the microprograms make " + std::to_string(result.runs) + " comparisons and " +
                          std::to_string(result.tests) + " tests, expected " +
                          std::to_string(visit.comparisons.runs) + " and " +
                          std::to_string(visit.comparisons.tests));
    if (result.event == Event::hit) {
        same("best", visit.hit.t);
        if (micro.number() != Word(visit.hit.voxel))
            throw GoldenError("the microprograms hit voxel " + std::to_string(std::int64_t(micro.number())) +
                              ", expected " + std::to_string(visit.hit.voxel));
    }
    Ray moved = ray;
    const double t = visit.event == Visit::Event::leaves_cube ? visit.hit.t : visit.crossing.t;
    if (visit.event == Visit::Event::leaves_cube) {
        start_outside(moved, t, context.arithmetic);
    } else if (visit.event == Visit::Event::forward && (ray.inverse_x != 0 || ray.inverse_y != 0)) {
        cross(moved, visit.crossing, context.arithmetic);
        same("side", double(int(visit.crossing.side)));
    } else {
        return;
    }
    same("t", t);
    same("next x", moved.position.x);
    same("next y", moved.position.y);
    same("z1", moved.position.z);
    if (!std::isinf(moved.reach)) same("next reach", moved.reach);
}

}  // namespace

std::string export_traversal(const std::vector<TraversalRecord>& records, const std::string& folder,
                             bool with_shading) {
    OutputSet files(folder + "/");
    std::string packages, index;
    std::size_t most_words = 0, rays = 0, voxels = 0;
    std::uint64_t charged = 0, cycles = 0, copies = 0, table = 0;
    struct Recorded {
        std::string store, vectors;
    };
    std::vector<Recorded> cells;
    std::optional<ShadingExport> shading;
    if (with_shading) {
        const CellSetup& first = *records.front().setup;
        shading.emplace(first.scene, first.picture, first.machine);
    }
    const auto share = [&](MicroImage& image) {
        if (shading) MicroImage::share({&image, &shading->image()});
    };
    for (const TraversalRecord& record : records) {
        const Context context(record.setup->scene, record.setup->picture);
        const VisitCalls calls(context);
        MicroImage image = image_of(calls);
        share(image);
        if (packages.empty()) packages = image.package() + image.instruction_file();
        if (packages != image.package() + image.instruction_file())
            throw GoldenError(record.file->name + ": its microprograms differ from those of " +
                              records.front().file->name + "; expected records of one run");
        MicroVisit micro(calls, context);
        Recorded cell;
        std::size_t tests = 0;
        const auto add = [&](Word value) {
            cell.vectors += MicroImage::hexadecimal(value, image.register_bits()) + "\n";
        };
        const TraversalReplay replay = replay_traversal(
            *record.file, *record.setup, 1,
            [&](const TraversalSetting& setting, const Ray& ray, const Visit& visit) {
                if (tests++ == 0) {
                    micro.take(setting.store);
                    if (shading) shading->cell(setting.store, setting.x, setting.y);
                }
                if (shading && visit.event == Visit::Event::hit && !is_shadow(ray.kind))
                    shading->hit(ray, visit.hit);
                micro.take(ray);
                for (const Word word : micro.words()) add(word);
                add(Word(micro.shadow()) << 2 | Word(micro.finite()) << 1 | Word(micro.outside()));
                const MicroVisit::Result result = micro.visit();
                check(micro, result, calls, ray, visit, context);
                add(Word(result.event));
                add(result.event == MicroVisit::Event::hit ? micro.number() : 0);
                for (const std::uint64_t n :
                     {result.runs, result.tests, result.edges, result.cycles, result.copies})
                    add(Word(n));
                for (const Word word : micro.words()) add(word);
                charged += result.charged;
                cycles += result.cycles;
                copies += result.copies;
                table += visit_cycles(visit, record.setup->picture, record.setup->machine.costs);
            });
        if (shading) shading->finish();
        if (!replay.failures.empty()) throw GoldenError(record.file->name + ": " + replay.failures.front());
        for (const Word word : micro.store())
            cell.store += MicroImage::hexadecimal(word, image.register_bits()) + "\n";
        index += std::to_string(tests) + " " + std::to_string(micro.lines()) + " " +
                 std::to_string(micro.store().size()) + "\n";
        most_words = std::max(most_words, micro.store().size());
        rays += tests;
        voxels += micro.lines();
        cells.push_back(std::move(cell));
    }
    const CellSetup& setup = *records.front().setup;
    const Context context(setup.scene, setup.picture);
    const VisitCalls calls(context);
    MicroImage image = image_of(calls);
    share(image);
    std::string names;
    for (const std::string& name : calls.fields()) names += name_in_file(name) + "\n";
    const VisitFiles lists = visit_files(calls, image, most_words, setup.picture.hit == HitTest::edge);
    std::vector<std::pair<std::string, std::string>> all = {{"microcode.sv", image.package()},
                                                            {"visit.sv", lists.package},
                                                            {"programs.hex", image.instruction_file()},
                                                            {"tables.hex", image.table_file()},
                                                            {"copies.hex", lists.copies},
                                                            {"calls.hex", lists.calls},
                                                            {"registers.hex", image.register_file()},
                                                            {"fields.txt", names},
                                                            {"visits.txt", index}};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        all.emplace_back("store_" + std::to_string(i) + ".hex", std::move(cells[i].store));
        all.emplace_back("visits_" + std::to_string(i) + ".hex", std::move(cells[i].vectors));
    }
    if (shading) {
        for (auto& file : shading->files()) all.push_back(std::move(file));
    }
    std::vector<std::string> suffixes;
    for (const auto& [name, text] : all) suffixes.push_back(name);
    files.announce(suffixes);
    for (const auto& [name, text] : all) files.write(name, text);
    files.publish();
    std::ostringstream said;
    said << folder << ": " << records.size() << " cells, " << voxels << " voxels, " << rays
         << " rays; the programs take " << cycles << " cycles, " << charged
         << " of them of programs in the cost table, which says " << table << ", and " << copies
         << " copies\n";
    if (shading) said << folder << ": " << shading->said();
    return said.str();
}

}  // namespace raycell
