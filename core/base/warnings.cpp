#include "core/base/warnings.h"

#include "core/base/error.h"

namespace penumbra {

void Warnings::add(const std::string& text) {
    if (strict_) throw Error(ErrorKind::BadData, text);
    if (texts_.size() > kMost || !seen_.insert(text).second) return;
    texts_.push_back(texts_.size() < kMost ? text : "there are more warnings than these; the rest is not shown");
}

}  // namespace penumbra
