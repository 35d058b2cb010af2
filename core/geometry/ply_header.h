// PlyHeader: what the text at the start of a PLY file says about the data behind it.
//
// Source: Greg Turk, The PLY Polygon File Format (1994), with the type names int8 ... float64 that came later.
#pragma once

#include "core/base/byte_reader.h"

#include <cstdint>
#include <string>
#include <vector>

namespace penumbra {

enum class PlyFormat { Ascii, BinaryLittleEndian, BinaryBigEndian };

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };

std::size_t sizeOf(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;  ///< of the value, or of each value of a list
    bool isList = false;
    PlyType countType = PlyType::Uint8;  ///< of the length of a list; an integer type
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::Ascii;
    std::vector<PlyElement> elements;  ///< in the order of their data

    const PlyElement* find(std::string_view name) const;
};

/// Reads up to and with the line end_header; lines end in LF or CR LF. A header of more than 64 KB, or one that claims
/// more data than the reader has, is refused: after this, every count is bounded by the size of the file. Messages are
/// "file:line: ...".
PlyHeader readPlyHeader(ByteReader& bytes);

}  // namespace penumbra
