#include "core/geometry/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>

namespace penumbra {

namespace {

constexpr std::size_t kLongestHeader = std::size_t{64} << 10;

struct TypeName {
    const char* name;
    PlyType type;
};
constexpr std::array kTypeNames{
    TypeName{"char", PlyType::Int8},      TypeName{"uchar", PlyType::Uint8},    TypeName{"short", PlyType::Int16},
    TypeName{"ushort", PlyType::Uint16},  TypeName{"int", PlyType::Int32},      TypeName{"uint", PlyType::Uint32},
    TypeName{"float", PlyType::Float32},  TypeName{"double", PlyType::Float64}, TypeName{"int8", PlyType::Int8},
    TypeName{"uint8", PlyType::Uint8},    TypeName{"int16", PlyType::Int16},    TypeName{"uint16", PlyType::Uint16},
    TypeName{"int32", PlyType::Int32},    TypeName{"uint32", PlyType::Uint32},  TypeName{"float32", PlyType::Float32},
    TypeName{"float64", PlyType::Float64}};

std::vector<std::string_view> split(std::string_view line) {
    constexpr std::string_view kBlanks = " \t";
    std::vector<std::string_view> words;
    for (std::size_t begin = line.find_first_not_of(kBlanks); begin != line.npos;) {
        const std::size_t end = std::min(line.find_first_of(kBlanks, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(kBlanks, end);
    }
    return words;
}

class HeaderParser {
public:
    explicit HeaderParser(ByteReader& bytes) : bytes_(bytes) {}

    PlyHeader parse() {
        if (nextLine() != "ply") fail("not a PLY file: its first line is not 'ply'");
        for (;;) {
            const std::vector<std::string_view> words = split(nextLine());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") break;
            if (words[0] == "format")
                parseFormat(words);
            else if (words[0] == "element")
                parseElement(words);
            else if (words[0] == "property")
                parseProperty(words);
            else
                fail("unknown word " + quote(words[0]) +
                     "; expected format, element, property, comment, obj_info or end_header");
        }
        if (!hasFormat_) fail("the header has no 'format' line");
        checkSizes();
        return std::move(header_);
    }

private:
    [[noreturn]] void fail(const std::string& message) const {
        throw Error(ErrorKind::BadData, bytes_.name() + ":" + std::to_string(line_) + ": " + message);
    }

    /// Valid until the next call.
    std::string_view nextLine() {
        bytes_.consume(lineLength_);
        headerLength_ += lineLength_;
        ++line_;
        const std::size_t mostLeft = kLongestHeader - headerLength_;
        bytes_.fill(mostLeft);  // in the end there may be fewer
        const std::size_t visible = std::min(mostLeft, bytes_.available());
        const void* newline = visible == 0 ? nullptr : std::memchr(bytes_.data(), '\n', visible);
        if (!newline) {
            if (line_ == 1) fail("not a PLY file: its first line is not 'ply'");
            fail(visible < mostLeft ? "the file ends before 'end_header'" : "no 'end_header' within the first 64 KB");
        }
        const std::string_view line(bytes_.data(), static_cast<const char*>(newline) - bytes_.data());
        lineLength_ = line.size() + 1;
        return line.substr(0, line.size() - (line.ends_with('\r') ? 1 : 0));
    }

    void parseFormat(const std::vector<std::string_view>& words) {
        if (hasFormat_) fail("a second 'format' line");
        if (words.size() != 3) fail("expected 'format', its name and its version");
        if (words[1] == "ascii")
            header_.format = PlyFormat::Ascii;
        else if (words[1] == "binary_little_endian")
            header_.format = PlyFormat::BinaryLittleEndian;
        else if (words[1] == "binary_big_endian")
            header_.format = PlyFormat::BinaryBigEndian;
        else
            fail("unknown format " + quote(words[1]) + "; known: ascii, binary_little_endian, binary_big_endian");
        if (words[2] != "1.0") fail("unknown version " + quote(words[2]) + "; known: 1.0");
        hasFormat_ = true;
    }

    void parseElement(const std::vector<std::string_view>& words) {
        if (words.size() != 3) fail("expected 'element', its name and its count");
        if (header_.find(words[1])) fail("a second element " + quote(words[1]));
        PlyElement element;
        element.name = words[1];
        const char* const end = words[2].data() + words[2].size();
        const auto [rest, status] = std::from_chars(words[2].data(), end, element.count);
        if (rest != end || status != std::errc())
            fail("bad count " + quote(words[2]) + " of element " + quote(words[1]));
        header_.elements.push_back(std::move(element));
    }

    void parseProperty(const std::vector<std::string_view>& words) {
        if (header_.elements.empty()) fail("a property before the first element");
        PlyProperty property;
        property.isList = words.size() > 1 && words[1] == "list";
        if (words.size() != (property.isList ? 5 : 3))
            fail("expected 'property TYPE NAME' or 'property list COUNT-TYPE TYPE NAME'");
        if (property.isList) {
            property.countType = parseType(words[2]);
            if (property.countType == PlyType::Float32 || property.countType == PlyType::Float64)
                fail("the length of a list cannot be of type " + quote(words[2]));
        }
        property.type = parseType(words[words.size() - 2]);
        property.name = words.back();
        std::vector<PlyProperty>& known = header_.elements.back().properties;
        if (std::any_of(known.begin(), known.end(), [&](const PlyProperty& p) { return p.name == property.name; }))
            fail("a second property " + quote(property.name) + " of element " + quote(header_.elements.back().name));
        known.push_back(std::move(property));
    }

    PlyType parseType(std::string_view word) const {
        for (const auto& [name, type] : kTypeNames)
            if (word == name) return type;
        std::vector<std::string> known;
        for (const auto& [name, type] : kTypeNames)
            known.push_back(name);
        fail("unknown type " + quote(word) + suggestion(word, known));
    }

    /// The fewest bytes an entry can take: all its lists empty; in a text, a digit and a blank for each value.
    std::uint64_t leastBytes(const PlyElement& element) const {
        if (header_.format == PlyFormat::Ascii) return 2 * element.properties.size();
        std::uint64_t sum = 0;
        for (const PlyProperty& p : element.properties)
            sum += sizeOf(p.isList ? p.countType : p.type);
        return sum;
    }

    void checkSizes() {
        bytes_.consume(lineLength_);
        // One more than there is: the last value of a text may lack its blank.
        std::uint64_t left = bytes_.mostBytesLeft() + (header_.format == PlyFormat::Ascii ? 1 : 0);
        for (const PlyElement& element : header_.elements) {
            const std::uint64_t least = leastBytes(element);
            if (least == 0) continue;  // without properties there are no data
            if (element.count > left / least)
                fail("element " + quote(element.name) + " has " + std::to_string(element.count) +
                     " entries of at least " + std::to_string(least) + " bytes, which is more than the file holds");
            left -= element.count * least;
        }
    }

    ByteReader& bytes_;
    PlyHeader header_;
    std::size_t line_ = 0, lineLength_ = 0, headerLength_ = 0;
    bool hasFormat_ = false;
};

}  // namespace

std::size_t sizeOf(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

const PlyElement* PlyHeader::find(std::string_view name) const {
    const auto found =
        std::find_if(elements.begin(), elements.end(), [&](const PlyElement& e) { return e.name == name; });
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader readPlyHeader(ByteReader& bytes) {
    return HeaderParser(bytes).parse();
}

}  // namespace penumbra
