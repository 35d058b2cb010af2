#include "core/base/unicode.h"

#include "core/base/error.h"

#include <cstdlib>
#include <memory>

#include <utf8proc.h>

namespace penumbra {

std::string composed(std::string_view utf8) {
    utf8proc_uint8_t* text = nullptr;
    const auto size = utf8proc_map(reinterpret_cast<const utf8proc_uint8_t*>(utf8.data()), utf8proc_ssize_t(utf8.size()),
                                   &text, utf8proc_option_t(UTF8PROC_STABLE | UTF8PROC_COMPOSE));
    const std::unique_ptr<utf8proc_uint8_t, void (*)(void*)> owner(text, std::free);
    if (size < 0) throw Error(ErrorKind::BadData, quote(utf8) + ": " + utf8proc_errmsg(size));
    return std::string(reinterpret_cast<const char*>(text), std::size_t(size));
}

}  // namespace penumbra
