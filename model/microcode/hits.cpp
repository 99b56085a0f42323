// Programs around a hit's setup and its shading that the cost table has no entries of its own for.
#include <algorithm>

#include "model/microcode/programs.hpp"

namespace raycell {

MicroProgram place_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("place", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const std::string& name, const Format& format) {
        return a.reg(name, format.bits(), format.fraction_bits());
    };
    const RegisterIndex from[] = {reg("x", f.unit), reg("y", f.unit), reg("z", f.depth)};
    const RegisterIndex way[] = {reg("dx", f.unit), reg("dy", f.unit), reg("dz", f.unit)};
    const RegisterIndex t = reg("t", f.distance);
    const RegisterIndex base = reg("base", f.depth);
    const RegisterIndex drop_x = a.reg("drop x", 2, 0);
    const RegisterIndex drop_z = a.reg("drop z", 2, 0);
    const RegisterIndex point[] = {reg("px", f.unit), reg("py", f.unit), reg("pz", f.depth)};
    // As `normal` takes them: either may be a place in the cell or a depth.
    const int fraction = std::max(f.unit.fraction_bits(), f.depth.fraction_bits());
    const int bits = f.depth.bits() + 1 + fraction - f.depth.fraction_bits();
    const RegisterIndex u = a.reg("u", bits, fraction);
    const RegisterIndex v = a.reg("v", bits, fraction);
    for (std::size_t i = 0; i < 3; ++i) a.sum(point[i], from[i], {{t, way[i]}});
    a.round(u, point[0]);
    a.round(v, point[1]);
    a.jump_zero(drop_z, "z stays");
    a.end();
    a.label("z stays");
    a.difference(v, point[2], base);
    a.jump_zero(drop_x, "done");
    a.round(u, point[1]);
    a.label("done");
    a.end();
    return a.finish();
}

MicroProgram total_program(const MicroSetting& setting) {
    const Formats f = setting.formats();
    Assembler a("total", setting.datapath, setting.numbers.rounding);
    const auto reg = [&](const std::string& name, const Format& format) {
        return a.reg(name, format.bits(), format.fraction_bits());
    };
    const RegisterIndex mirror = reg("mirror", f.feature);
    const RegisterIndex transmit = reg("transmit", f.feature);
    for (const std::string channel : {"x", "y", "z"}) {
        const RegisterIndex local = reg("local " + channel, f.intensity);
        const RegisterIndex reflected = reg("reflected " + channel, f.intensity);
        const RegisterIndex refracted = reg("refracted " + channel, f.intensity);
        a.sum(reg("sum " + channel, f.intensity), local, {{reflected, mirror}, {refracted, transmit}});
    }
    a.end();
    return a.finish();
}

MicroProgram nothing_program(const MicroSetting& setting) {
    Assembler a("nothing", setting.datapath, setting.numbers.rounding);
    a.reg("unused", 2, 0);  // an instruction has fields for registers
    a.end();
    return a.finish();
}

}  // namespace raycell
