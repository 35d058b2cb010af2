// What a test needs to say of a piece of work that it must end in an Error.
#pragma once

#include "core/base/error.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace penumbra {

/// The message of the Error that `work` ends in; a failure of the test where it has another kind, or there is none.
inline std::string messageOf(const std::function<void()>& work, ErrorKind kind = ErrorKind::BadData) {
    try {
        work();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.what();
        return e.what();
    }
    ADD_FAILURE() << "no error";
    return {};
}

}  // namespace penumbra
