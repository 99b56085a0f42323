// Load messages bit by bit, as the wires carry them (docs/reference/messages.md).
#pragma once

#include <vector>

#include "model/geometry/placement.hpp"
#include "model/loading/span.hpp"
#include "model/machine/wire_bits.hpp"

namespace raycell {

/// Type codes of load messages, their first three bits. Loading is a phase of its own.
enum class LoadType : std::uint8_t {
    viewer,  ///< all its sources are points
    features,
    polygon,
    surface,
    trapeze,
    span,
    end_of_scene,
    viewer_of_kinds  ///< its sources begin with their kinds
};

/// What every cell latches before the objects come: the viewer, what lies beyond the cube, its levels, the
/// sources.
struct ViewerMessage {
    dvec3 eye{0, 0, 0};
    bool at_infinity = false;
    std::array<bool, 6> beyond{};
    dvec3 background{0, 0, 0};
    int depth_levels = 1;
    double level = 1;
    std::vector<Source> sources;
    bool tells_kinds = false;  ///< each source begins with its kind: unless all are points
    int samples = 1;           ///< of each source that is an area
    double share = 1;          ///< 1 / samples
};

/// The first message of a scene.
struct Context;
ViewerMessage viewer_of(const Context& context);

/// Packs and unpacks the load messages of one machine in words; their layouts follow the rung, the normals
/// and the display. An object's index is in none of them: its features come before its polygons. What the
/// trapezes of a polygon share is in the message before them.
class LoadWire {
  public:
    LoadWire(const PictureSettings& picture, const Formats& formats);

    /// Throw std::range_error naming the field for a value that has no code.
    WireBits pack(const ViewerMessage& viewer) const;
    WireBits pack(const Material& features) const;
    WireBits pack(const Polygon& polygon) const;
    WireBits pack(const Surface& surface) const;
    WireBits pack(const Trapeze& trapeze, const CornerIntensities& intensities) const;
    WireBits pack(const Span& span) const;
    WireBits end_of_scene() const;

    ViewerMessage unpack_viewer(const WireBits& bits) const;
    Material unpack_features(const WireBits& bits) const;
    Polygon unpack_polygon(const WireBits& bits) const;
    Surface unpack_surface(const WireBits& bits) const;
    Trapeze unpack_trapeze(const WireBits& bits, CornerIntensities& intensities) const;
    Span unpack_span(const WireBits& bits) const;

    /// The layouts; of a message with edges, vertices or sources with one of them, with `viewer_of_kinds`
    /// one of `kind`.
    std::vector<WireField> layout(LoadType type, SourceKind kind = SourceKind::point) const;

  private:
    template <typename... Parts>
    WireBits packed(Parts... parts) const;
    template <typename Message>
    Message unpacked(const WireBits& bits) const;
    template <typename Archive>
    void fields(Archive& archive, ViewerMessage& viewer) const;
    template <typename Archive>
    void fields(Archive& archive, Material& features) const;
    template <typename Archive>
    void fields(Archive& archive, Polygon& polygon) const;
    template <typename Archive>
    void fields(Archive& archive, Surface& surface) const;
    template <typename Archive>
    void fields(Archive& archive, Trapeze& trapeze, CornerIntensities& intensities) const;
    template <typename Archive>
    void fields(Archive& archive, Span& span) const;

    Formats formats_;
    HitTest hit_;
    Normals normals_;
    bool gouraud_;
    int x_bits_;
    int y_bits_;
};

}  // namespace raycell
