#include "model/files/array_file.hpp"

#include <cstring>
#include <stdexcept>

#include "model/numbers/hash.hpp"

namespace raycell {
namespace {

constexpr std::uint64_t magic = 0x336c6c6563796172ULL;  // "raycell" and a version

/// Hashes a sequence of numbers. Every number counts as 64 bits, so that writing, reading and hashing share
/// one list of fields.
class Hasher {
  public:
    void number(std::uint64_t value) {
        hash_.add(value);
        hash_.fold(29);
    }
    std::uint64_t hash() const { return hash_.value(); }

  private:
    Fnv hash_;
};

class Writer {
  public:
    explicit Writer(std::FILE* file) : file_(file) {}
    void number(std::uint64_t value) {
        unsigned char bytes[8];
        for (int i = 0; i < 8; ++i) bytes[i] = static_cast<unsigned char>(value >> 8 * i);
        std::fwrite(bytes, 1, sizeof bytes, file_);
        hasher_.number(value);
    }
    void finish() { number(hasher_.hash()); }

  private:
    std::FILE* file_;
    Hasher hasher_;
};

class Reader {
  public:
    Reader(std::FILE* file, const std::string& name) : file_(file), name_(name) {}
    std::uint64_t next() {
        unsigned char bytes[8];
        if (std::fread(bytes, 1, sizeof bytes, file_) != sizeof bytes)
            fail("is cut off; expected a whole loaded array");
        std::uint64_t value = 0;
        for (int i = 0; i < 8; ++i) value |= std::uint64_t(bytes[i]) << 8 * i;
        last_ = hasher_.hash();
        hasher_.number(value);
        return value;
    }
    /// Reads a count; fails if it is larger than `most`.
    std::size_t count(std::uint64_t most) {
        const std::uint64_t value = next();
        if (value > most) fail("is damaged; expected a loaded array");
        return std::size_t(value);
    }
    void finish() {
        if (next() != last_) fail("is damaged: its checksum is another one");
        if (std::fgetc(file_) != EOF) fail("is longer than a loaded array");
    }
    [[noreturn]] void fail(const char* what) const { throw std::runtime_error(name_ + ": " + what); }

  private:
    std::FILE* file_;
    const std::string& name_;
    Hasher hasher_;
    std::uint64_t last_ = 0;  ///< hash of everything before the last number
};

std::uint64_t bits_of(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// Writes fields to a Writer or a Hasher.
template <typename Out>
class Put {
  public:
    explicit Put(Out& out) : out_(out) {}
    template <typename T>
    void whole(const T& value) {
        out_.number(std::uint64_t(std::int64_t(value)));
    }
    void real(double value) { out_.number(bits_of(value)); }
    void vector(const dvec3& v) { real(v.x), real(v.y), real(v.z); }

  private:
    Out& out_;
};

/// Reads the same fields from a Reader.
class Get {
  public:
    explicit Get(Reader& in) : in_(in) {}
    template <typename T>
    void whole(T& value) {
        const std::uint64_t number = in_.next();
        value = T(number);
        if (std::uint64_t(std::int64_t(value)) != number) in_.fail("is damaged; expected a loaded array");
    }
    void real(double& value) {
        const std::uint64_t bits = in_.next();
        std::memcpy(&value, &bits, sizeof value);
    }
    void vector(dvec3& v) { real(v.x), real(v.y), real(v.z); }

  private:
    Reader& in_;
};

template <typename A, typename V>
void fields_of_voxel(A& a, V& v) {
    a.whole(v.polygon), a.whole(v.object), a.whole(v.near_level), a.whole(v.far_level);
    a.real(v.near), a.real(v.far), a.real(v.base);
    a.vector(v.plane.n), a.real(v.plane.c);
    a.vector(v.normal.base), a.vector(v.normal.du), a.vector(v.normal.dv);
    a.whole(v.drop), a.whole(v.pieces), a.whole(v.edge_count), a.whole(v.first_edge), a.whole(v.mask);
    for (auto& side : v.window) a.whole(side);
    a.vector(v.point), a.real(v.area);
}

template <typename A, typename E>
void fields_of_edge(A& a, E& edge) {
    a.real(edge.a), a.real(edge.b), a.real(edge.c), a.whole(edge.piece);
}

void put_cell(Writer& writer, const CellStore& cell) {
    Put<Writer> put(writer);
    put.whole(cell.overflowed), put.whole(cell.last_overflowed);
    put.whole(cell.voxels.size()), put.whole(cell.edges.size()), put.whole(cell.intensities.size());
    for (const Voxel& voxel : cell.voxels) fields_of_voxel(put, voxel);
    for (const EdgeFunction& edge : cell.edges) fields_of_edge(put, edge);
    for (const dvec3& intensity : cell.intensities) put.vector(intensity);
}

constexpr std::uint64_t most_things = std::uint64_t(1) << 40;

CellStore get_cell(Reader& reader) {
    Get get(reader);
    CellStore cell;
    get.whole(cell.overflowed), get.whole(cell.last_overflowed);
    const std::size_t voxels = reader.count(most_things);
    const std::size_t edges = reader.count(most_things);
    const std::size_t intensities = reader.count(most_things);
    // Grows one element at a time: a damaged count must not ask for memory that the file can't fill.
    for (std::size_t i = 0; i < voxels; ++i) fields_of_voxel(get, cell.voxels.emplace_back());
    make_index(cell);
    for (std::size_t i = 0; i < edges; ++i) fields_of_edge(get, cell.edges.emplace_back());
    for (std::size_t i = 0; i < intensities; ++i) get.vector(cell.intensities.emplace_back());
    return cell;
}

template <typename A>
void put_scene(A& a, const CellScene& scene) {
    const Frame& frame = scene.frame;
    a.whole(frame.width), a.whole(frame.height), a.whole(frame.depth_levels), a.real(frame.depth);
    a.whole(frame.viewer_at_infinity), a.vector(frame.eye);
    a.whole(scene.objects.size());
    for (const Material& m : scene.objects) {
        a.vector(m.colour), a.real(m.diffuse), a.real(m.specular), a.real(m.shine);
        a.real(m.transmit), a.real(m.ior), a.whole(m.mirror);
    }
    a.whole(scene.sources.size());
    for (const Source& source : scene.sources) {
        a.vector(source.position), a.vector(source.intensity);
        if (source.kind == SourceKind::point) continue;
        a.whole(source.kind), a.vector(source.axis), a.real(source.cut_off), a.real(source.falloff);
        a.vector(source.edge_u), a.vector(source.edge_v), a.real(source.radius);
    }
    a.whole(scene.polygons.size());
    for (const Polygon& polygon : scene.polygons) {
        a.whole(polygon.id), a.whole(polygon.object), a.whole(polygon.drop), a.real(polygon.slack);
        a.vector(polygon.plane.n), a.real(polygon.plane.c);
        a.vector(polygon.normal.base), a.vector(polygon.normal.du), a.vector(polygon.normal.dv);
        a.whole(polygon.vertices.size());
        for (const dvec3& vertex : polygon.vertices) a.vector(vertex);
    }
}

}  // namespace

std::uint64_t loading_key(const CellScene& scene, const PictureSettings& picture) {
    Hasher hasher;
    Put<Hasher> put(hasher);
    put_scene(put, scene);
    const PictureSettings& p = picture;
    put.whole(int(p.hit)), put.whole(int(p.normals)), put.whole(int(p.display)), put.whole(p.voxel_capacity);
    const NumberSettings& n = p.numbers;
    put.whole(int(n.arithmetic)), put.whole(n.word_bits), put.whole(int(n.rounding));
    return hasher.hash();
}

std::uint64_t loading_timing(const MachineSettings& machine) {
    Hasher hasher;
    Put<Hasher> put(hasher);
    put.whole(machine.buffer_depth), put.whole(machine.link_bits);
    put.whole(machine.feed_bits), put.whole(machine.feed_lanes), put.whole(machine.load_queue);
    put.whole(machine.loading_units);
    const CostTable& c = machine.costs;
    for (const std::uint32_t cost :
         {c.load_depth, c.load_interval, c.load_plane, c.load_mask, c.load_edge, c.load_forward,
          c.load_advance, c.load_order, c.geometry_polygon, c.geometry_skip, c.precomputation_trapeze,
          c.distribution_span, c.distribution_pass})
        put.whole(cost);
    return hasher.hash();
}

void write_array(std::FILE* file, const LoadedArray& array) {
    Writer writer(file);
    Put<Writer> put(writer);
    put.whole(magic), put.whole(array.key), put.whole(array.timing), put.whole(array.cells.size()),
        put.whole(array.counts.size());
    for (const std::uint64_t count : array.counts) writer.number(count);
    for (const CellStore& cell : array.cells) put_cell(writer, cell);
    writer.finish();
}

LoadedArray read_array(std::FILE* file, const std::string& name) {
    Reader reader(file, name);
    if (reader.next() != magic) reader.fail("is no loaded array, or of another version");
    LoadedArray array;
    array.key = reader.next();
    array.timing = reader.next();
    const std::size_t cells = reader.count(std::uint64_t(1) << 24);
    const std::size_t counts = reader.count(most_things);
    for (std::size_t i = 0; i < counts; ++i) array.counts.push_back(reader.next());
    for (std::size_t i = 0; i < cells; ++i) array.cells.push_back(get_cell(reader));
    reader.finish();
    return array;
}

}  // namespace raycell
