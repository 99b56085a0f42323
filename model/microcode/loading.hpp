// The parts of the microprograms of loading: what a cell does with a span (loading/span.cpp, part.cpp,
// coverage.cpp, voxel.cpp).
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/microcode/programs.hpp"

namespace raycell {

/// Writes parts of loading into one program. Each part reads the registers of the parts before it, and jumps
/// to "none" where the polygon turns out not to touch the cell.
class LoadingWriter {
  public:
    LoadingWriter(Assembler& assembler, const MicroSetting& setting, const DepthLevels& levels);

    /// The registers that a span carries, but for rung `depth`.
    void take_span();
    /// The same of its normals alone.
    void take_normals();
    /// The same of rung `depth`: the axis only matters to its normals.
    void take_depth_span();
    void take_way();
    void advance(HitTest rung, Normals normals);

    /// The corners of a part, in two banks, and a line that cuts them.
    void take_corners();
    void take_line();
    /// Keeps what lies inside the line.
    void cut();
    /// The lowest and highest depth of a part, its middle and its area.
    void take_measures();
    /// What a mask needs to know of a part, too.
    void take_bounds();
    /// The whole part: rectangle, lines, measures; with what take_bounds() says, if it was called.
    void part();

    void take_run();
    /// Levels and ends of the run from "z low" to "z high".
    void run(bool with_room);
    /// Another piece joins a voxel: run, point, how far what counts from the run's beginning moves.
    void join();
    /// The edges that cross the run: rung `edge` holds them, rung `mask` only needs to know which.
    void cross(HitTest rung);
    void take_edges();
    /// One edge, as a voxel has it.
    void edge();
    /// The mask and its window.
    void mask();
    void take_anchor();
    /// Rung `depth`: the run and the middle are the span's depth at the cell's centre.
    void centre();
    void anchor();
    void slopes();
    void plane();
    void normal(Normals normals, HitTest rung);

  private:
    using Vector = std::array<RegisterIndex, 3>;
    struct Line {
        RegisterIndex a, b, c;
    };
    struct Corner {
        RegisterIndex u, v;
    };
    /// One axis of a mask.
    struct MaskAxis {
        RegisterIndex from, to, size;               ///< the run's rectangle
        RegisterIndex low, high;                    ///< the part's bounds
        RegisterIndex first, last;                  ///< the window, 32nds
        RegisterIndex border;                       ///< array: where each eighth of the window begins
        RegisterIndex first_touched, last_touched;  ///< eighths that the bounds touch
    };

    RegisterIndex slope(const std::string& name) { return a_.reg(name, f_ + 2, f_); }
    RegisterIndex length(const std::string& name, int more = 0) { return a_.reg(name, loading_ + more, f_); }
    RegisterIndex number_of(const std::string& name, int bits) { return a_.reg(name, bits, 0); }
    RegisterIndex number(const std::string& name) { return number_of(name, 6); }
    RegisterIndex loading_constant(const std::string& name, double value, int bits);
    Vector vector(const std::string& name, int bits, int fraction);
    Corner corner(const std::string& name);
    void copy(const Corner& to, const Corner& from);
    void value(RegisterIndex target, const Line& line, const Corner& at);
    /// The line becomes the span's edge, or bound, of this number.
    void fetch_line(RegisterIndex number);
    void side_of(const std::string& name, const Corner& from, const Corner& to, RegisterIndex from_at,
                 RegisterIndex to_at);
    void add_cut_point();
    void rectangle();
    void add_bounds();
    void measure();
    void level_of(const std::string& name, RegisterIndex depth, RegisterIndex level);
    void ends();
    int far_bits() const;
    void convert(RegisterIndex target, RegisterIndex a);
    void largest(const std::vector<RegisterIndex>& of, RegisterIndex size, RegisterIndex other);
    MaskAxis mask_axis(const std::string& axis, RegisterIndex from, RegisterIndex to, RegisterIndex low,
                       RegisterIndex high);
    void window(const std::string& axis, const MaskAxis& m);
    void window_end(const std::string& name, const MaskAxis& m, RegisterIndex off, RegisterIndex end,
                    bool upwards);
    void borders(const std::string& axis, const MaskAxis& m);
    void touched(const std::string& axis, const MaskAxis& m);
    void narrow(const MaskAxis& u, const MaskAxis& v);
    void flat_normal(const Vector& base);
    void steep_normal();

    Assembler& a_;
    const Formats formats_;
    const DepthLevels levels_;
    const int loading_;  ///< bits of a loading word
    const int f_;        ///< its fraction bits
    const int v_bits_;   ///< of a coordinate v, which may be a depth
    RegisterIndex zero_, one_, one_length_, no_length_;
    // The span.
    RegisterIndex x_, last_, passes_, nu_, nv_, c_, negative_, drop_x_, drop_z_, z_, dz_, slack_, edges_,
        edge_a_, edge_b_, edge_c_;
    Vector base_, du_, dv_, n_, dn_;
    // The part.
    RegisterIndex u_, v_, begin_, other_, count_, out_;
    Line line_, height_;
    Corner p_, q_, first_, from_, way_;
    RegisterIndex p_at_, q_at_, first_at_, rest_, by_, quotient_, room_, lines_;
    RegisterIndex middle_u_, middle_v_, area_, z_low_, z_high_;
    // The voxel.
    RegisterIndex near_level_, far_level_, near_, far_, cube_end_, level_step_, last_level_;
    RegisterIndex held_u_, held_v_, anchor_v_, plane_u_, plane_v_, size_, other_size_, scale_, to_normal_;
    Vector normal_base_, normal_du_, normal_dv_, near_base_;
    RegisterIndex crossings_, held_a_, held_b_, held_c_, from_v_, to_v_, minus_hair_;
    // The mask.
    Corner low_{Assembler::none, Assembler::none};
    Corner high_{Assembler::none, Assembler::none};
    RegisterIndex crossing_edges_, hair_, one_bit_, eight_, row_, from_column_, to_column_;
};

}  // namespace raycell
