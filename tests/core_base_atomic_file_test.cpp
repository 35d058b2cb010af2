// Files that appear whole or not at all.

#include "core/base/atomic_file.h"

#include "tests/expect_error.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

namespace penumbra {
namespace {

/// Writes the path in a child process that is not root, which may write everywhere. Returns the kind of its error, 0
/// for none.
int attemptUnprivileged(const std::string& path) {
    constexpr uid_t kNobody = 65534;
    const pid_t child = ::fork();
    if (child == 0) {
        if (::geteuid() == 0 && ::setuid(kNobody) != 0) ::_exit(1);
        try {
            writeFileAtomically(path, "x");
        } catch (const Error& e) {
            ::_exit(int(e.kind()));
        }
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(AtomicFile, AppearsOnCommitAndReplacesTheOld) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.bin", "old");
    AtomicFile file(path);
    file.write("new ");
    EXPECT_EQ(readBytes(path), "old");
    file.write("bytes");
    file.commit();
    EXPECT_EQ(readBytes(path), "new bytes");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const TemporaryFolder folder;
    { AtomicFile(folder.path("a")).write("x"); }
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(AtomicFile, WhatAKilledProcessLeftIsRemovedAndNothingElse) {
    const TemporaryFolder folder;
    const std::string path = folder.path("a.bin");
    const pid_t child = ::fork();
    if (child == 0) {
        AtomicFile file(path);
        file.write("half");
        ::_exit(0);  // as if killed: nothing is tidied up
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(folder.fileCount(), 1u);
    const AtomicFile living(path), other(folder.path("b.bin"));
    folder.file(".a.bin.tmp.elsewhere.1.01234567", "of another machine");
    folder.file(".a.bin.tmp", "of somebody else");
    EXPECT_EQ(folder.fileCount(), 5u);
    removeAbandonedTemporaries(path);
    EXPECT_EQ(folder.fileCount(), 4u);
    removeAbandonedTemporaries(folder.path("no/such/folder"));
}

TEST(AtomicFile, SeeksBackAndBeyondTheEnd) {
    const TemporaryFolder folder;
    AtomicFile file(folder.path("a"));
    file.write("0123456789");
    file.seek(2);
    file.write("xy");
    EXPECT_EQ(file.position(), 4u);
    file.seek(12);
    file.write("z");
    file.commit();
    EXPECT_EQ(readBytes(folder.path("a")), std::string("01xy456789\0\0z", 13));
}

TEST(AtomicFile, FollowsLinksAndKeepsTheMode) {
    const TemporaryFolder folder;
    const std::string target = folder.file("target", "old"), link = folder.path("link");
    ::chmod(target.c_str(), 0640);
    ASSERT_EQ(::symlink(target.c_str(), link.c_str()), 0);
    writeFileAtomically(link, "new");
    EXPECT_EQ(readBytes(target), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    struct stat status;
    ASSERT_EQ(::stat(target.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(AtomicFile, ImpossiblePathsCannotBeCreated) {
    const TemporaryFolder folder;
    const auto refused = [](const std::string& path) {
        return messageOf([&] { writeFileAtomically(path, "x"); }, ErrorKind::CannotCreate);
    };
    EXPECT_NE(refused("").find("No such file"), std::string::npos);
    EXPECT_NE(refused(folder.path("no/such/folder/a")).find("No such file"), std::string::npos);
    EXPECT_NE(refused(folder.path("")).find("directory"), std::string::npos);
    EXPECT_NE(refused(folder.path(std::string(300, 'a'))).find("too long"), std::string::npos);
    EXPECT_NE(refused(folder.path(std::string("a\0b", 3))).find("Invalid"), std::string::npos);
    EXPECT_NE(refused(folder.file("file", "x") + "/a").find("Not a directory"), std::string::npos);
    EXPECT_EQ(refused("/dev/null/a").find("/dev/null/a: "), 0u);
    writeFileAtomically(folder.path(std::string(255, 'a')), "x");  // the longest name there is
}

TEST(AtomicFile, ReadOnlyFoldersAndFilesCannotBeCreated) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a", "old");
    ::chmod(path.c_str(), 0444);
    ::chmod(folder.path("").c_str(), 0777);
    EXPECT_EQ(attemptUnprivileged(path), int(ErrorKind::CannotCreate));
    EXPECT_EQ(attemptUnprivileged(folder.path("b")), 0);
    ::chmod(folder.path("").c_str(), 0555);
    EXPECT_EQ(attemptUnprivileged(folder.path("c")), int(ErrorKind::CannotCreate));
    ::chmod(folder.path("").c_str(), 0755);
    EXPECT_EQ(readBytes(path), "old");
    EXPECT_EQ(folder.fileCount(), 2u);
}

TEST(AtomicFile, FullDeviceCannotBeWrittenAndDevicesStayDevices) {
    const std::string message = messageOf([] { writeFileAtomically("/dev/full", "x"); }, ErrorKind::CannotWrite);
    EXPECT_NE(message.find("/dev/full: "), std::string::npos);
    EXPECT_NE(message.find("No space"), std::string::npos);
    writeFileAtomically("/dev/null", "x");
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(AtomicFile, AWriteThatFailsLeavesTheOldFileAndNoTemporary) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a", "old");
    struct rlimit old;
    ::getrlimit(RLIMIT_FSIZE, &old);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const struct rlimit small { 1000, old.rlim_max };
    ::setrlimit(RLIMIT_FSIZE, &small);
    const std::string message =
        messageOf([&] { writeFileAtomically(path, std::string(5000, 'x')); }, ErrorKind::CannotWrite);
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find("from byte 1000 on"), std::string::npos) << message;
    EXPECT_EQ(readBytes(path), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

}  // namespace
}  // namespace penumbra
