#include "core/geometry/ply.h"

#include "core/geometry/ply_header.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace penumbra {

namespace {

static_assert(std::endian::native == std::endian::little);

/// What is wrong with one entry; PlyBody adds the file and the entry.
struct BadEntry {
    std::string message;
};

[[noreturn]] void failTruncated() {
    throw BadEntry{"the file ends within it"};
}

// The two decoders have one interface: scalar() gives the next value as a double, which holds every PLY type exactly,
// and skip() passes over `count` values.

template <bool kBigEndian>
class BinaryDecoder {
public:
    explicit BinaryDecoder(ByteReader& bytes) : bytes_(bytes) {}

    double scalar(PlyType type) {
        switch (type) {
            case PlyType::Int8:
                return load<std::int8_t, std::uint8_t>();
            case PlyType::Uint8:
                return load<std::uint8_t, std::uint8_t>();
            case PlyType::Int16:
                return load<std::int16_t, std::uint16_t>();
            case PlyType::Uint16:
                return load<std::uint16_t, std::uint16_t>();
            case PlyType::Int32:
                return load<std::int32_t, std::uint32_t>();
            case PlyType::Uint32:
                return load<std::uint32_t, std::uint32_t>();
            case PlyType::Float32:
                return load<float, std::uint32_t>();
            default:
                return load<double, std::uint64_t>();
        }
    }
    void skip(PlyType type, std::uint64_t count) {
        if (!bytes_.skip(count * sizeOf(type))) failTruncated();
    }
    bool hasMore() { return bytes_.fill(1); }

private:
    template <class T, class Bits>
    T load() {
        if (!bytes_.fill(sizeof(Bits))) failTruncated();
        Bits bits;
        std::memcpy(&bits, bytes_.data(), sizeof bits);
        bytes_.consume(sizeof bits);
        if constexpr (kBigEndian) {
            if constexpr (sizeof(Bits) == 2) bits = __builtin_bswap16(bits);
            if constexpr (sizeof(Bits) == 4) bits = __builtin_bswap32(bits);
            if constexpr (sizeof(Bits) == 8) bits = __builtin_bswap64(bits);
        }
        return std::bit_cast<T>(bits);
    }

    ByteReader& bytes_;
};

class AsciiDecoder {
public:
    explicit AsciiDecoder(ByteReader& bytes) : bytes_(bytes) {}

    double scalar(PlyType) {
        const std::string_view word = nextWord();
        const char* const end = word.data() + word.size();
        const char* const begin = word.data() + (word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0);
        double value = 0;
        const auto [rest, status] = std::from_chars(begin, end, value);
        if (rest != end || status == std::errc::invalid_argument)
            throw BadEntry{"expected a number, found " + quote(word)};
        if (status == std::errc::result_out_of_range) value = outOfRangeValue(word);
        return value;
    }
    void skip(PlyType, std::uint64_t count) {
        for (; count > 0; --count)
            nextWord();
    }
    bool hasMore() { return skipBlanks(); }

private:
    static constexpr std::size_t kLongestWord = 256;

    static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

    /// Below the least double or above the largest one. A word too short for 300 digits is so by its exponent.
    static double outOfRangeValue(std::string_view word) {
        const std::size_t exponent = word.find_first_of("eE");
        if (exponent + 1 < word.size() && word[exponent + 1] == '-') return 0;
        return std::copysign(std::numeric_limits<double>::infinity(), word[0] == '-' ? -1.0 : 1.0);
    }

    /// False at the end of the file.
    bool skipBlanks() {
        while (bytes_.fill(1)) {
            std::size_t n = 0;
            while (n < bytes_.available() && isBlank(bytes_.data()[n]))
                ++n;
            const bool found = n < bytes_.available();
            bytes_.consume(n);
            if (found) return true;
        }
        return false;
    }

    /// Valid until the next call.
    std::string_view nextWord() {
        if (!skipBlanks()) failTruncated();
        bytes_.fill(kLongestWord + 1);
        const std::size_t most = std::min(bytes_.available(), kLongestWord + 1);
        std::size_t n = 1;
        while (n < most && !isBlank(bytes_.data()[n]))
            ++n;
        if (n > kLongestWord) throw BadEntry{"expected a number, found more than 256 letters without a blank"};
        bytes_.consume(n);
        return {bytes_.data() - n, n};
    }

    ByteReader& bytes_;
};

constexpr int kSkipped = -1;

/// Where x y z nx ny nz u v stand in a row of vertex values: kSkipped, or their index below.
struct VertexLayout {
    std::vector<int> slotOfProperty;
    bool hasNormals = false, hasUvs = false;
};
constexpr int kPositionSlot = 0, kNormalSlot = 3, kUvSlot = 6, kSlots = 8;

class VertexLayoutBuilder {
public:
    explicit VertexLayoutBuilder(const PlyElement& vertex) : vertex_(vertex) {
        layout_.slotOfProperty.assign(vertex.properties.size(), kSkipped);
    }

    VertexLayout build(const std::string& file, Warnings& warnings) {
        if (!assign({"x", "y", "z"}, kPositionSlot))
            throw Error(ErrorKind::BadData, file + ": element 'vertex' lacks x, y or z");
        layout_.hasNormals = assign({"nx", "ny", "nz"}, kNormalSlot);
        if (!layout_.hasNormals && (has("nx") || has("ny") || has("nz")))
            warnings.add(file + ": vertices have only some of nx, ny, nz; the normals are ignored");
        layout_.hasUvs = assign({"u", "v"}, kUvSlot) || assign({"s", "t"}, kUvSlot) ||
                         assign({"texture_u", "texture_v"}, kUvSlot) || assign({"texture_s", "texture_t"}, kUvSlot);
        return std::move(layout_);
    }

private:
    std::ptrdiff_t indexOf(std::string_view name) const {
        const auto& list = vertex_.properties;
        const auto found =
            std::find_if(list.begin(), list.end(), [&](const auto& p) { return p.name == name && !p.isList; });
        return found == list.end() ? -1 : found - list.begin();
    }
    bool has(std::string_view name) const { return indexOf(name) >= 0; }

    /// All of the names, or none.
    bool assign(std::initializer_list<std::string_view> names, int firstSlot) {
        if (!std::all_of(names.begin(), names.end(), [&](std::string_view name) { return has(name); })) return false;
        for (const std::string_view name : names)
            layout_.slotOfProperty[indexOf(name)] = firstSlot++;
        return true;
    }

    const PlyElement& vertex_;
    VertexLayout layout_;
};

/// The data behind the header: walks through the elements in their order and fills the mesh.
class PlyBody {
public:
    PlyBody(ByteReader& bytes, const PlyHeader& header, Warnings& warnings)
        : bytes_(bytes), header_(header), file_(bytes.name()), warnings_(warnings) {}

    PatchMesh read() {
        checkElements();
        switch (header_.format) {
            case PlyFormat::Ascii:
                readAll(AsciiDecoder(bytes_));
                break;
            case PlyFormat::BinaryLittleEndian:
                readAll(BinaryDecoder<false>(bytes_));
                break;
            case PlyFormat::BinaryBigEndian:
                readAll(BinaryDecoder<true>(bytes_));
                break;
        }
        chooseDiagonals();
        if (skippedPolygons_ > 0)
            warnings_.add(file_ + ": " + std::to_string(skippedPolygons_) +
                          " polygons of neither 3 nor 4 corners are skipped");
        if (mesh_.indices.empty()) warnings_.add(file_ + ": has no triangles");
        return {std::move(mesh_), std::move(quads_)};
    }

private:
    void checkElements() {
        vertex_ = header_.find("vertex");
        face_ = header_.find("face");
        if (!vertex_) throw Error(ErrorKind::BadData, file_ + ": has no element 'vertex'");
        if (!face_) throw Error(ErrorKind::BadData, file_ + ": has no element 'face'");
        // Vertices have 32-bit numbers, and so have triangles, of which a face makes up to two.
        constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max() / 2;
        if (vertex_->count > kMost || face_->count > kMost)
            throw Error(ErrorKind::BadData, file_ + ": has more than 2^31 vertices or faces");
    }

    template <class Decoder>
    void readAll(Decoder decoder) {
        for (const PlyElement& element : header_.elements) {
            entry_ = 0;
            try {
                if (&element == vertex_)
                    readVertices(decoder);
                else if (&element == face_)
                    readFaces(decoder);
                else
                    skipElement(decoder, element);
            } catch (const BadEntry& bad) {
                const bool known = &element == vertex_ || &element == face_;   // other names may hold anything
                throw Error(ErrorKind::BadData, file_ + ": " + (known ? element.name : quote(element.name)) + " " +
                                                    std::to_string(entry_) + " of " + std::to_string(element.count) + ": " +
                                                    bad.message);
            }
        }
        if (decoder.hasMore()) warnings_.add(file_ + ": has more data than its header says; the rest is ignored");
    }

    template <class Decoder>
    void skipElement(Decoder& decoder, const PlyElement& element) {
        if (element.properties.empty()) return;  // its count is bounded by nothing
        for (; entry_ < element.count; ++entry_)
            for (const PlyProperty& property : element.properties)
                skipProperty(decoder, property);
    }

    template <class Decoder>
    static void skipProperty(Decoder& decoder, const PlyProperty& property) {
        decoder.skip(property.type, property.isList ? listLength(decoder, property) : 1);
    }

    template <class Decoder>
    static std::uint64_t listLength(Decoder& decoder, const PlyProperty& property) {
        const double length = decoder.scalar(property.countType);
        if (!(length >= 0 && length <= std::numeric_limits<std::uint32_t>::max()) || length != std::floor(length))
            throw BadEntry{"a list cannot have the length " + shown(length)};
        return static_cast<std::uint64_t>(length);
    }

    template <class Decoder>
    void readVertices(Decoder& decoder) {
        const VertexLayout layout = VertexLayoutBuilder(*vertex_).build(file_, warnings_);
        reserveVertices(mesh_.positions, vertex_->count);
        if (layout.hasNormals) mesh_.normals.reserve(3 * vertex_->count);
        if (layout.hasUvs) mesh_.uvs.reserve(2 * vertex_->count);
        float row[kSlots];
        for (; entry_ < vertex_->count; ++entry_) {
            for (std::size_t i = 0; i < layout.slotOfProperty.size(); ++i) {
                const PlyProperty& property = vertex_->properties[i];
                const int slot = layout.slotOfProperty[i];
                if (slot == kSkipped)
                    skipProperty(decoder, property);
                else
                    row[slot] = static_cast<float>(decoder.scalar(property.type));
            }
            mesh_.positions.insert(mesh_.positions.end(), row + kPositionSlot, row + kNormalSlot);
            if (layout.hasNormals) mesh_.normals.insert(mesh_.normals.end(), row + kNormalSlot, row + kUvSlot);
            if (layout.hasUvs) mesh_.uvs.insert(mesh_.uvs.end(), row + kUvSlot, row + kSlots);
        }
    }

    template <class Decoder>
    void readFaces(Decoder& decoder) {
        const PlyProperty* corners = findFaceProperty("vertex_indices", true);
        if (!corners) corners = findFaceProperty("vertex_index", true);
        if (!corners) throw Error(ErrorKind::BadData, file_ + ": element 'face' has no list 'vertex_indices'");
        const PlyProperty* number = findFaceProperty("face_indices", false);
        mesh_.indices.reserve(3 * mostFacesLeft(*corners, 3));
        if (number) mesh_.faceIndices.reserve(mostFacesLeft(*corners, 3));
        for (; entry_ < face_->count; ++entry_) {
            const std::size_t before = mesh_.triangleCount();
            std::int32_t faceNumber = 0;
            for (const PlyProperty& property : face_->properties) {
                if (&property == corners)
                    readCorners(decoder, property);
                else if (&property == number)
                    faceNumber = toFaceNumber(decoder.scalar(property.type));
                else
                    skipProperty(decoder, property);
            }
            if (number) mesh_.faceIndices.insert(mesh_.faceIndices.end(), mesh_.triangleCount() - before, faceNumber);
        }
    }

    /// How many faces of so many corners may follow: a bound for memory that a file of empty polygons cannot inflate.
    std::uint64_t mostFacesLeft(const PlyProperty& corners, std::uint64_t cornersOfEach) const {
        const std::uint64_t bytesOfIndex = header_.format == PlyFormat::Ascii ? 2 : sizeOf(corners.type);
        return std::min(face_->count - entry_, bytes_.mostBytesLeft() / (1 + cornersOfEach * bytesOfIndex) + 1);
    }

    const PlyProperty* findFaceProperty(std::string_view name, bool isList) const {
        for (const PlyProperty& property : face_->properties)
            if (property.name == name && property.isList == isList) return &property;
        return nullptr;
    }

    template <class Decoder>
    void readCorners(Decoder& decoder, const PlyProperty& property) {
        const std::uint64_t count = listLength(decoder, property);
        if (count != 3 && count != 4) {
            ++skippedPolygons_;
            return decoder.skip(property.type, count);
        }
        std::uint32_t corner[4];
        for (std::uint64_t i = 0; i < count; ++i)
            corner[i] = toVertexIndex(decoder.scalar(property.type));
        if (count == 4) {
            // Where one is a quad, most are.
            if (quads_.empty()) mesh_.indices.reserve(mesh_.indices.size() + 6 * mostFacesLeft(property, 4));
            quads_.push_back(static_cast<std::uint32_t>(mesh_.triangleCount()));
        }
        mesh_.indices.insert(mesh_.indices.end(), corner, corner + 3);
        if (count == 4) mesh_.indices.insert(mesh_.indices.end(), {corner[0], corner[2], corner[3]});
    }

    std::uint32_t toVertexIndex(double value) const {
        if (!(value >= 0 && value < static_cast<double>(vertex_->count)) || value != std::floor(value))
            throw BadEntry{"there is no vertex " + shown(value) + ", only 0 to " + std::to_string(vertex_->count) +
                           " - 1"};
        return static_cast<std::uint32_t>(value);
    }

    static std::int32_t toFaceNumber(double value) {
        if (!(std::abs(value) <= std::numeric_limits<std::int32_t>::max()))
            throw BadEntry{"its number " + shown(value) + " does not fit 32 bits"};
        return static_cast<std::int32_t>(value);
    }

    static std::string shown(double value) {
        char text[32];
        return {text, std::to_chars(text, text + sizeof text, value).ptr};
    }

    /// A quad that is concave at its second or fourth corner is cut from there. After reading, because faces may come
    /// before vertices.
    void chooseDiagonals() {
        for (const std::uint32_t first : quads_) {
            std::uint32_t* const t = &mesh_.indices[3 * std::size_t{first}];
            const std::uint32_t a = t[0], b = t[1], c = t[2], d = t[5];
            if (agree(triangleNormal(mesh_, a, b, c), triangleNormal(mesh_, a, c, d)) ||
                !agree(triangleNormal(mesh_, a, b, d), triangleNormal(mesh_, b, c, d)))
                continue;
            const std::uint32_t cut[6] = {a, b, d, b, c, d};
            std::copy_n(cut, 6, t);
        }
    }
    static bool agree(Vec3d m, Vec3d n) { return m.x * n.x + m.y * n.y + m.z * n.z >= 0; }

    ByteReader& bytes_;
    const PlyHeader& header_;
    const std::string& file_;
    Warnings& warnings_;
    const PlyElement* vertex_ = nullptr;
    const PlyElement* face_ = nullptr;
    TriangleMesh mesh_;
    std::vector<std::uint32_t> quads_;  ///< the first triangle of each
    std::uint64_t entry_ = 0, skippedPolygons_ = 0;
};

PatchMesh readMesh(ByteReader bytes, Warnings& warnings) {
    const PlyHeader header = readPlyHeader(bytes);
    return PlyBody(bytes, header, warnings).read();
}

}  // namespace

PatchMesh readPly(const std::string& path, Warnings& warnings) {
    return readMesh(ByteReader::open(path), warnings);
}

PatchMesh readPlyBytes(std::string_view bytes, const std::string& name, Warnings& warnings) {
    return readMesh(ByteReader::overMemory(bytes, name), warnings);
}

}  // namespace penumbra
