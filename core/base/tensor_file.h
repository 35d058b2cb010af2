// Tensor files: named arrays of numbers, the container of measured materials (RGL's ".bsdf").
//
// Format, little endian: "tensor_file" and a zero byte, version (two bytes: 1, 0), the number of fields (uint32), and
// for each field its name (uint16 length, bytes), number of dimensions (uint16), type of its elements (one byte, the
// enumeration below), where its elements begin in the file (uint64) and its shape (a uint64 for each dimension).
//
// Hostile input: whatever a header claims must lie within the bytes there are, so that nothing can be asked for that the
// file does not hold; anything else throws Error(BadData) that says which field. Thread safety: immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra {

class TensorFile {
public:
    struct Field {
        enum class Type : std::uint8_t { Uint8 = 1, Int8, Uint16, Int16, Uint32, Int32, Uint64, Int64, Float16, Float32, Float64 };
        Type type{};
        std::vector<std::size_t> shape;
        std::size_t count = 0;  ///< of elements
        std::size_t begin = 0;  ///< offset of the first in the file
    };

    explicit TensorFile(std::vector<char> bytes);

    /// The elements of a field of floats with that many dimensions, finite numbers all; throws where there is none such.
    std::vector<float> floats(std::string_view name, std::size_t dimensions) const;
    /// Of the same fields. REQUIRES: floats() did not throw.
    const std::vector<std::size_t>& shape(std::string_view name) const { return fields_.find(name)->second.shape; }
    const std::map<std::string, Field, std::less<>>& fields() const { return fields_; }

private:
    std::vector<char> bytes_;
    std::map<std::string, Field, std::less<>> fields_;
};

}  // namespace penumbra
