// Programs around the walk and the tests: what else the traversal unit computes for a ray in a cell
// (tracing/tracing.cpp, tracing/intersect.cpp). They are not in the cost table.
#include "model/microcode/programs.hpp"

namespace raycell {
namespace {

std::int64_t raw(double value, const Format& format) { return std::int64_t(value / format.step()); }

/// Registers by their formats.
class VisitWriter {
  public:
    VisitWriter(const char* name, const MicroSetting& setting)
        : f(setting.formats()), a(name, setting.datapath, setting.numbers.rounding) {}
    RegisterIndex reg(const char* name, const Format& format, int more = 0) {
        return a.reg(name, format.bits() + more, format.fraction_bits());
    }
    RegisterIndex flag(const char* name) { return a.reg(name, 2, 0); }
    RegisterIndex constant(const char* name, double value, const Format& format) {
        return a.constant(name, raw(value, format), format.bits(), format.fraction_bits());
    }

    const Formats f;
    Assembler a;
};

}  // namespace

MicroProgram reached_program(const MicroSetting& setting) {
    VisitWriter w("reached", setting);
    const RegisterIndex reach = w.reg("reach", w.f.reach);
    const RegisterIndex z = w.reg("z", w.f.depth);
    const RegisterIndex dz = w.reg("dz", w.f.unit);
    const RegisterIndex t = w.reg("t", w.f.distance);
    const RegisterIndex z_end = w.reg("z1", w.f.depth);
    w.a.round(t, reach);
    w.a.sum(z_end, z, {{t, dz}});
    w.a.end();
    return w.a.finish();
}

MicroProgram range_program(const MicroSetting& setting, double hair) {
    VisitWriter w("range", setting);
    const RegisterIndex z = w.reg("z", w.f.depth);
    const RegisterIndex z_end = w.reg("z1", w.f.depth);
    const RegisterIndex low = w.reg("low", w.f.depth, 1);
    const RegisterIndex high = w.reg("high", w.f.depth, 1);
    const RegisterIndex room = w.constant("hair", hair, w.f.depth);
    w.a.least(low, z, z_end);
    w.a.most(high, z, z_end);
    w.a.subtract(low, low, room);
    w.a.add(high, high, room);
    w.a.end();
    return w.a.finish();
}

MicroProgram narrow_program(const MicroSetting& setting, double tie) {
    VisitWriter w("narrow", setting);
    const RegisterIndex z = w.reg("z", w.f.depth);
    const RegisterIndex dz = w.reg("dz", w.f.unit);
    const RegisterIndex t = w.reg("t", w.f.distance);
    const RegisterIndex low = w.reg("low", w.f.depth, 1);
    const RegisterIndex high = w.reg("high", w.f.depth, 1);
    const RegisterIndex end = w.reg("end", w.f.depth);
    const RegisterIndex bound = w.reg("bound", w.f.depth, 1);
    const RegisterIndex room = w.constant("tie", tie, w.f.depth);
    w.a.sum(end, z, {{t, dz}});
    w.a.jump_negative(dz, "outwards");
    w.a.add(bound, end, room);
    w.a.least(high, high, bound);
    w.a.end();
    w.a.label("outwards");
    w.a.subtract(bound, end, room);
    w.a.most(low, low, bound);
    w.a.end();
    return w.a.finish();
}

MicroProgram nearer_program(const MicroSetting& setting, double tie) {
    VisitWriter w("nearer", setting);
    const RegisterIndex t = w.reg("t", w.f.distance);
    const RegisterIndex best = w.reg("best", w.f.distance);
    const RegisterIndex lower = w.flag("lower");
    const RegisterIndex nearer = w.flag("nearer");
    const RegisterIndex bound = w.reg("bound", w.f.distance, 1);
    const RegisterIndex room = w.constant("tie", tie, w.f.distance);
    const RegisterIndex no = w.a.constant("no", 0, 2, 0);
    const RegisterIndex yes = w.a.constant("yes", 1, 2, 0);
    w.a.move(nearer, yes);
    w.a.jump_zero(lower, "higher");
    w.a.add(bound, best, room);
    w.a.jump_less(bound, t, "beyond");
    w.a.end();
    w.a.label("higher");
    w.a.subtract(bound, best, room);
    w.a.jump_less(t, bound, "nearer");
    w.a.label("beyond");
    w.a.move(nearer, no);
    w.a.label("nearer");
    w.a.end();
    return w.a.finish();
}

MicroProgram at_source_program(const MicroSetting& setting, double hair) {
    VisitWriter w("at source", setting);
    const RegisterIndex t = w.reg("t", w.f.distance);
    const RegisterIndex reach = w.reg("reach", w.f.reach);
    const RegisterIndex there = w.flag("there");
    const RegisterIndex room = w.constant("hair", hair, w.f.distance);
    const RegisterIndex no = w.a.constant("no", 0, 2, 0);
    const RegisterIndex yes = w.a.constant("yes", 1, 2, 0);
    w.a.move(there, no);
    w.a.jump_sum_negative({{t}, {room}, {reach, true}}, "before");
    w.a.move(there, yes);
    w.a.label("before");
    w.a.end();
    return w.a.finish();
}

MicroProgram projection_program(const MicroSetting& setting) {
    VisitWriter w("projection", setting);
    const RegisterIndex x = w.reg("px", w.f.unit);
    const RegisterIndex y = w.reg("py", w.f.unit);
    const RegisterIndex z = w.reg("pz", w.f.depth);
    const RegisterIndex base = w.reg("base", w.f.depth);
    const RegisterIndex drop_x = w.flag("drop x");
    const RegisterIndex drop_z = w.flag("drop z");
    const RegisterIndex u = w.reg("u", w.f.depth, 1);
    const RegisterIndex v = w.reg("v", w.f.depth, 1);
    w.a.round(u, x);
    w.a.round(v, y);
    w.a.jump_zero(drop_z, "z stays");
    w.a.end();
    w.a.label("z stays");
    w.a.difference(v, z, base);
    w.a.jump_zero(drop_x, "done");
    w.a.round(u, y);
    w.a.label("done");
    w.a.end();
    return w.a.finish();
}

}  // namespace raycell
