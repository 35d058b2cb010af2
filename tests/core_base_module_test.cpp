// Modules that are not there, or are not what they ought to be, end in a clear Error.
#include "core/base/module.h"

#include "core/image/oiio_module.h"
#include "tests/expect_error.h"

#include <gtest/gtest.h>

namespace penumbra {
namespace {

TEST(Module, MissingIsAConfigurationErrorThatNamesIt) {
    const std::string message =
        messageOf([] { loadModuleFunction("penumbra_nothing.so", "penumbraNothing"); }, ErrorKind::Configuration);
    EXPECT_NE(message.find("penumbra_nothing.so"), std::string::npos) << message;
    EXPECT_NE(message.find("lib/penumbra"), std::string::npos) << message;
}

TEST(Module, WithoutTheFunctionIsAConfigurationErrorThatNamesIt) {
    const std::string message =
        messageOf([] { loadModuleFunction(kOiioModuleFile, "penumbraNothing"); }, ErrorKind::Configuration);
    EXPECT_NE(message.find("penumbraNothing"), std::string::npos) << message;
}

TEST(Module, OfAnotherVersionGivesNoInterface) {
    const auto interface =
        reinterpret_cast<OiioModuleFunction*>(loadModuleFunction(kOiioModuleFile, kOiioModuleFunction));
    EXPECT_EQ(interface("0.0.0"), nullptr);
}

}  // namespace
}  // namespace penumbra
