#include "core/base/tensor_file.h"

#include "core/base/error.h"

#include <cmath>
#include <cstring>

namespace penumbra {
namespace {

constexpr std::string_view kMagic{"tensor_file\0", 12};
constexpr std::size_t kMostDimensions = 16, kMostFields = 1024;

[[noreturn]] void fail(const std::string& text) {
    throw Error(ErrorKind::BadData, "not a usable tensor file: " + text);
}

/// The header, byte by byte.
class Cursor {
public:
    explicit Cursor(std::string_view bytes) : left_(bytes) {}
    std::string_view take(std::size_t n) {
        if (n > left_.size()) fail("it ends within its header");
        const std::string_view taken = left_.substr(0, n);
        left_.remove_prefix(n);
        return taken;
    }
    template <class T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }

private:
    std::string_view left_;
};

std::size_t sizeOf(TensorFile::Field::Type type, const std::string& name) {
    constexpr std::size_t kSizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8};
    if (std::size_t(type) == 0 || std::size_t(type) >= std::size(kSizes))
        fail("the field '" + name + "' has elements of an unknown type");
    return kSizes[std::size_t(type)];
}

}  // namespace

TensorFile::TensorFile(std::vector<char> bytes) : bytes_(std::move(bytes)) {
    Cursor cursor({bytes_.data(), bytes_.size()});
    if (bytes_.size() < kMagic.size() || cursor.take(kMagic.size()) != kMagic) fail("it does not begin as one");
    const auto major = cursor.number<std::uint8_t>(), minor = cursor.number<std::uint8_t>();
    if (major != 1 || minor != 0) fail("version " + std::to_string(major) + "." + std::to_string(minor) + " is unknown");
    const auto fieldCount = cursor.number<std::uint32_t>();
    if (fieldCount > kMostFields) fail(std::to_string(fieldCount) + " fields are too many");
    for (std::uint32_t i = 0; i < fieldCount; ++i) {
        const std::string name(cursor.take(cursor.number<std::uint16_t>()));
        const auto dimensions = cursor.number<std::uint16_t>();
        if (dimensions > kMostDimensions) fail("the field '" + name + "' has too many dimensions");
        Field field;
        field.type = Field::Type(cursor.number<std::uint8_t>());
        const std::size_t elementSize = sizeOf(field.type, name);
        const auto begin = cursor.number<std::uint64_t>();
        if (begin > bytes_.size()) fail("the field '" + name + "' lies beyond its end");
        field.begin = std::size_t(begin);
        const std::size_t most = (bytes_.size() - field.begin) / elementSize;
        field.count = 1;
        for (std::size_t d = 0; d < dimensions; ++d) {
            const auto extent = cursor.number<std::uint64_t>();
            if (extent == 0) fail("the field '" + name + "' is empty");
            if (extent > most / field.count) fail("the field '" + name + "' does not fit into it");
            field.shape.push_back(std::size_t(extent));
            field.count *= std::size_t(extent);
        }
        fields_.insert_or_assign(name, std::move(field));
    }
}

std::vector<float> TensorFile::floats(std::string_view name, std::size_t dimensions) const {
    const auto found = fields_.find(name);
    const std::string text = "the field '" + std::string(name) + "'";
    if (found == fields_.end()) fail(text + " is missing");
    const Field& field = found->second;
    if (field.type != Field::Type::Float32) fail(text + " does not hold floats");
    if (field.shape.size() != dimensions)
        fail(text + " has " + std::to_string(field.shape.size()) + " dimensions in place of " + std::to_string(dimensions));
    std::vector<float> values(field.count);
    std::memcpy(values.data(), bytes_.data() + field.begin, field.count * sizeof(float));
    for (const float x : values)
        if (!std::isfinite(x)) fail(text + " holds numbers that are not finite");
    return values;
}

}  // namespace penumbra
