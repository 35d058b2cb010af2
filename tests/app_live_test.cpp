// Pictures that are looked at while they are rendered: kept on disk (--write-partial) and sent to a viewer
// (--display-server).
#include "app/batch/live_display.h"
#include "app/batch/partial_writer.h"
#include "app/batch/recipe.h"
#include "core/base/parallel.h"
#include "tests/expect_error.h"
#include "tests/integrators_fixture.h"
#include "tests/picture_files.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <map>

namespace penumbra {
namespace {

using namespace test;
using namespace std::chrono_literals;

nlohmann::json recipeOf(const ExrFile& file) {
    return nlohmann::json::parse(recipeText(file));
}

/// Of all pixels together, as the file's channel says.
double samplesIn(const ExrFile& file) {
    double sum = 0;
    for (std::size_t c = 0; c < file.header.channels.size(); ++c)
        if (file.header.channels[c].name == "samples")
            for (const std::uint32_t n : file.uints[c])
                sum += n;
    return sum;
}

/// Stops a job that has one thread after so many packets of rays.
class Stopper final : public RayRecorder {
public:
    explicit Stopper(int packets) : left_(packets) {}
    void nearest(const RayHitPacket&, unsigned, Coherence) override {
        if (--left_ == 0) stop = true;
    }
    void shadow(const RayPacket&, unsigned) override {}
    std::atomic<bool> stop{false};

private:
    int left_;
};

/// ---- on disk ------------------------------------------------------------------------------------------------------

TEST(Watched, PassesOverThePictureChangeNoBit) {
    const SceneFolder folder;
    RenderOptions watched;
    watched.isWatched = true;
    const auto plain = renderText(roomText(), {}, folder.path()),
               passes = renderText(roomText(), watched, folder.path());
    EXPECT_TRUE(passes->film() == plain->film());
    EXPECT_EQ(passes->counts().rays, plain->counts().rays);
    EXPECT_TRUE(passes->isWhole());
    watched.tileSize = 5;
    EXPECT_TRUE(renderText(roomText(), watched, folder.path())->film() == plain->film());
}

/// Films of the room at every stage of its passes, read while threads render: each pixel has what its samples give.
TEST(Watched, WhatIsReadMeanwhileIsExactlyTheSamplesSoFar) {
    const SceneFolder folder;
    RenderOptions options;
    options.isWatched = true;
    const auto job = prepareText(roomText("sobol", 64), options, folder.path());
    std::thread render([&] { job->run(); });
    const int width = job->film().crop().width();
    std::map<std::size_t, std::map<std::uint32_t, PixelEstimate>> seen;  // by pixel and samples
    const auto look = [&] {
        job->visitTiles({0, 0, width, job->film().crop().height()}, [&](const Tile& t) {
            const std::size_t pixel = std::size_t(t.y0) * std::size_t(width) + std::size_t(t.x0);
            const PixelEstimate e = job->film().estimate(pixel);
            if (e.samples) seen[pixel][e.samples] = e;
        });
    };
    while (!job->isWhole())
        look();
    render.join();
    look();
    for (const auto& [pixel, stages] : seen) {
        const auto& [samples, estimate] = *stages.begin();  // the fewest
        __int128 sum = 0;
        for (std::uint32_t s = 0; s < samples; ++s)
            sum += toFixed(job->replay(int(pixel) % width, int(pixel) / width, s).value.g);
        EXPECT_EQ(fromFixed(sum) / samples * job->scene().filter.normalization(), estimate.mean[1]);
    }
}

TEST(PartialPicture, SaysHowMuchOfItIsDone) {
    const SceneFolder folder;
    const std::string path = folder.path("partial.exr");
    const ThreadLimit one(1);
    Stopper stopper(1000);
    RenderOptions options;
    options.isWatched = true;
    options.controls.recorder = &stopper;
    const auto job = prepareText(roomText("sobol", 16), options, folder.path());
    EXPECT_FALSE(job->run(&stopper.stop));
    job->writePicture(path);
    const ExrFile file = readExr(path);
    const nlohmann::json partial = recipeOf(file).at("partial");
    EXPECT_EQ(partial.at("samples"), 36 * 28 * 16);
    EXPECT_GT(partial.at("samples_done").get<double>(), 0);
    EXPECT_LT(partial.at("samples_done").get<double>(), 36 * 28 * 16);
    EXPECT_EQ(samplesIn(file), partial.at("samples_done").get<double>());
    EXPECT_FALSE(nlohmann::json::parse(recipeJson(*renderText(roomText(), {}, folder.path()))).contains("partial"));
}

TEST(PartialPicture, IsWrittenAgainAndAgainAndWarnsOnce) {
    const SceneFolder folder;
    RenderOptions options;
    options.isWatched = true;
    const auto job = prepareText(roomText(), options, folder.path());
    std::atomic<int> warnings{0};
    {
        const PartialWriter missing(*job, folder.path("no/such/folder.exr"), 0.01, [&](const std::string& text) {
            EXPECT_TRUE(contains(text, "the render goes on")) << text;
            ++warnings;
        });
        EXPECT_TRUE(waitUntil([&] { return warnings > 0; }));
        std::this_thread::sleep_for(100ms);
    }
    EXPECT_EQ(warnings, 1);
    const std::string path = folder.path("a.exr");
    const PartialWriter writer(*job, path, 0.01, [&](const std::string&) { ++warnings; });
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(waitUntil([&] { return std::filesystem::exists(path); }));
        std::filesystem::remove(path);
    }
    EXPECT_EQ(warnings, 1);
    EXPECT_TRUE(
        contains(messageOf([&] { PartialWriter(*job, "/dev/null", 1, {}); }, ErrorKind::Usage), "no regular file"));
}

class WatchedCommand : public testing::Test {
protected:
    const TemporaryFolder folder;
    const std::string scene = folder.file("scene.pbrt", kSmallScene), picture = folder.path("a.exr");
    std::vector<std::string> longRender(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", scene,          "-o",      picture, "--spp",
                                           "65536",  "--resolution", "160x120", "-t",    "1"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
};

TEST_F(WatchedCommand, ThePictureIsThatOfARenderThatNobodyWatches) {
    ASSERT_EQ(runProgram({"render", scene, "-o", picture, "--spp", "100", "--write-partial=0.01"}).code, 0);
    const std::string bytes = readBytes(picture);
    ASSERT_EQ(runProgram({"render", scene, "-o", picture, "--spp", "100"}).code, 0);
    EXPECT_TRUE(bytes == readBytes(picture));
}

/// Killed again and again, at another moment each time: what is on disk can be read, and the next render removes what
/// the killed one left beside it.
TEST_F(WatchedCommand, KilledAtAnyMomentItLeavesAPictureThatCanBeRead) {
    for (int round = 0; round < 8; ++round) {
        std::filesystem::remove(picture);
        StartedProgram program(longRender({"--write-partial=0.01", "--quiet"}));
        ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(picture); }));
        std::this_thread::sleep_for(std::chrono::milliseconds(37 * round));
        program.signal(SIGKILL);
        EXPECT_EQ(program.wait().code, 1000 + SIGKILL);
        const ExrFile file = readExr(picture);
        EXPECT_EQ(file.header.dataWindow.width(), 160);
        EXPECT_GT(recipeOf(readExr(picture)).at("partial").at("samples").get<double>(), 1e9);
    }
    EXPECT_EQ(runProgram({"render", scene, "-o", picture, "--spp", "1"}).code, 0);
    EXPECT_EQ(leftovers(folder.path("")), std::vector<std::string>{});
}

TEST_F(WatchedCommand, ASignalLeavesWhatThereIs) {
    StartedProgram program(longRender({"--write-partial=0.05"}));
    ASSERT_TRUE(waitUntil([&] { return std::filesystem::exists(picture); }));
    program.signal(SIGTERM);
    const ProgramRun run = program.wait();
    EXPECT_EQ(run.code, 128 + SIGTERM);
    EXPECT_TRUE(contains(run.err, "error: interrupted: " + picture + " holds ")) << run.err;
    const nlohmann::json partial = recipeOf(readExr(picture)).at("partial");
    EXPECT_GT(partial.at("samples_done").get<double>(), 0);
    EXPECT_EQ(samplesIn(readExr(picture)), partial.at("samples_done").get<double>());
    EXPECT_EQ(leftovers(folder.path("")), std::vector<std::string>{});
}

TEST_F(WatchedCommand, OptionsAreChecked) {
    const auto errorOf = [&](const std::string& option) {
        const ProgramRun run = runProgram({"render", scene, "-o", picture, option});
        EXPECT_EQ(run.code, 64) << option;
        return run.err;
    };
    for (const char* bad : {"0", "-1", "nan", "x", "1e99"})
        EXPECT_TRUE(contains(errorOf(std::string("--write-partial=") + bad), "error: --write-partial: '")) << bad;
    for (const char* bad : {"host:", "host:0", "host:65536", "host:x", ":"})
        EXPECT_TRUE(contains(errorOf(std::string("--display-server=") + bad), "error: --display-server: '")) << bad;
    const ProgramRun device = runProgram({"render", scene, "-o", "/dev/null", "--write-partial"});
    EXPECT_EQ(device.code, 64);
    EXPECT_TRUE(contains(device.err, "/dev/null: is no regular file")) << device.err;
}

/// ---- in a viewer --------------------------------------------------------------------------------------------------

TEST(DisplayAddress, IsAHostAndAPort) {
    const auto parts = [](const std::string& text) {
        const DisplayAddress a = parseDisplayAddress(text);
        return a.host + " " + a.port;
    };
    EXPECT_EQ(parts("localhost:99"), "localhost 99");
    EXPECT_EQ(parts("localhost"), "localhost 14158");
    EXPECT_EQ(parts(":99"), "127.0.0.1 99");
    EXPECT_EQ(parts("[::1]:99"), "::1 99");
    EXPECT_EQ(parts("[::1]"), "::1 14158");
}

/// Reads the protocol as its description has it, on a port of its own.
class Viewer {
public:
    enum class Manner { Reads, Sleeps, LeavesOnce };
    explicit Viewer(Manner manner = Manner::Reads) {
        listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), size), 0);
        EXPECT_EQ(::listen(listener_, 4), 0);
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this, manner] { serve(manner); });
    }
    ~Viewer() { finish(); }
    /// Waits until the client has gone.
    void finish() {
        ended_ = true;
        ::shutdown(listener_, SHUT_RDWR);
        if (thread_.joinable()) thread_.join();
        if (listener_ >= 0) ::close(std::exchange(listener_, -1));
    }

    DisplayAddress address() const { return {"127.0.0.1", std::to_string(port_)}; }
    std::string text() const { return "127.0.0.1:" + std::to_string(port_); }

    // After finish().
    std::string name;
    int width = 0, height = 0, created = 0, updates = 0;
    std::map<std::string, std::vector<float>> channels;
    bool understoodAll = true;
    std::atomic<int> connections{0};  // at any time

private:
    void serve(Manner manner) {
        while (true) {
            const int client = ::accept(listener_, nullptr, nullptr);
            if (client < 0) return;
            ++connections;
            if (manner == Manner::Sleeps)
                while (!ended_)
                    std::this_thread::sleep_for(10ms);
            else
                while (packet(client) && !(manner == Manner::LeavesOnce && connections == 1 && updates == 1)) {
                }
            ::close(client);
        }
    }
    static bool readAll(int socket, char* to, std::size_t size) {
        while (size > 0) {
            const ssize_t got = ::recv(socket, to, size, 0);
            if (got <= 0) return false;
            to += got;
            size -= std::size_t(got);
        }
        return true;
    }
    bool packet(int client) {
        std::uint32_t size = 0;
        if (!readAll(client, reinterpret_cast<char*>(&size), sizeof size)) return false;
        bytes_.resize(size - sizeof size);
        at_ = 0;
        if (!readAll(client, bytes_.data(), bytes_.size())) return false;
        const char type = take<char>();
        take<char>();  // "grab focus"
        const std::string image = text_();
        if (type == 4)
            create(image);
        else if (type == 5)
            update(image);
        else
            understoodAll = false;
        understoodAll = understoodAll && at_ == bytes_.size();
        return true;
    }
    void create(const std::string& image) {
        ++created;
        name = image;
        width = take<std::int32_t>();
        height = take<std::int32_t>();
        channels.clear();
        for (int n = take<std::int32_t>(); n > 0; --n)
            channels[text_()].assign(std::size_t(width) * std::size_t(height), -1);
    }
    void update(const std::string& image) {
        ++updates;
        understoodAll = understoodAll && image == name;
        std::vector<std::string> names(std::size_t(take<std::int32_t>()));
        for (std::string& n : names)
            n = text_();
        const int x0 = take<std::int32_t>(), y0 = take<std::int32_t>(), w = take<std::int32_t>(),
                  h = take<std::int32_t>();
        for (const std::string& n : names)
            for (int y = y0; y < y0 + h; ++y)
                for (int x = x0; x < x0 + w; ++x)
                    channels.at(n).at(std::size_t(y) * std::size_t(width) + std::size_t(x)) = take<float>();
    }
    template <class T>
    T take() {
        T value{};
        if (at_ + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + at_, sizeof value);
        at_ += sizeof value;
        return value;
    }
    std::string text_() {
        const std::string t(bytes_.c_str() + at_);
        at_ += t.size() + 1;
        return t;
    }

    int listener_ = -1, port_ = 0;
    std::atomic<bool> ended_{false};
    std::string bytes_;
    std::size_t at_ = 0;
    std::thread thread_;
};

/// Larger than a part that is sent at once, so that there are several.
std::string wideScene(int width, int height) {
    return "Camera \"perspective\"\n" + film(width, height) +
           "Sampler \"sobol\" \"integer pixelsamples\" 1\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [ .5 .25 1 ]\n"
           "Translate .3 0 4\nShape \"sphere\"\n";
}

void expectWholePicture(const Viewer& viewer, const RenderJob& job) {
    EXPECT_TRUE(viewer.understoodAll);
    ASSERT_EQ(viewer.width, job.film().crop().width());
    ASSERT_EQ(viewer.height, job.film().crop().height());
    EXPECT_EQ(viewer.channels.size(), 4u);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < job.film().pixelCount(); ++i) {
        const PixelEstimate e = job.film().estimate(i);
        wrong += viewer.channels.at("R")[i] != float(e.mean[0]) || viewer.channels.at("G")[i] != float(e.mean[1]) ||
                 viewer.channels.at("B")[i] != float(e.mean[2]) || viewer.channels.at("A")[i] != float(e.alpha);
    }
    EXPECT_EQ(wrong, 0u);
}

class DisplayServer : public testing::Test {
protected:
    /// Renders while the picture is shown, and waits for `until` before the display goes.
    void show(const DisplayAddress& address, const DisplayPatience& patience, const std::function<bool()>& until = {},
              int width = 200, int height = 150) {
        RenderOptions options;
        options.isWatched = true;
        job = prepareText(wideScene(width, height), options);
        std::chrono::steady_clock::time_point end;
        {
            const LiveDisplay display(
                *job, address, "picture.exr (1)", [&](const std::string&) { ++warnings; }, patience);
            EXPECT_TRUE(job->run());
            if (until) {
                EXPECT_TRUE(waitUntil(until));
            }
            end = std::chrono::steady_clock::now();
        }
        secondsAtTheEnd = std::chrono::duration<double>(std::chrono::steady_clock::now() - end).count();
    }

    std::unique_ptr<RenderJob> job;
    std::atomic<int> warnings{0};
    double secondsAtTheEnd = 0;
};

TEST_F(DisplayServer, GetsThePictureToTheBit) {
    Viewer viewer;
    show(viewer.address(), {});
    viewer.finish();
    EXPECT_EQ(warnings, 0);
    EXPECT_EQ(viewer.name, "picture.exr (1)");
    EXPECT_EQ(viewer.created, 1);
    EXPECT_GE(viewer.updates, 4);  // 200 x 150 pixels are four parts
    expectWholePicture(viewer, *job);
}

TEST_F(DisplayServer, ThatIsNotThereCostsOneWarning) {
    std::string port;
    {
        const Viewer gone;
        port = gone.address().port;
    }
    show({"127.0.0.1", port}, {.retry = 20ms}, [&] { return warnings > 0; });
    EXPECT_EQ(warnings, 1);
}

/// It takes connections and reads nothing: buffers fill, and nobody waits for it longer than patience says.
TEST_F(DisplayServer, ThatReadsNothingHoldsNobodyUp) {
    Viewer viewer(Viewer::Manner::Sleeps);
    show(
        viewer.address(), {.connect = 200ms, .send = 200ms, .retry = 100ms, .close = 500ms},
        [&] { return warnings > 0; }, 800, 700);
    viewer.finish();
    EXPECT_EQ(warnings, 1);
    EXPECT_LT(secondsAtTheEnd, 10);
}

TEST_F(DisplayServer, ThatComesBackGetsTheImageAnew) {
    Viewer viewer(Viewer::Manner::LeavesOnce);
    show(viewer.address(), {.retry = 20ms}, [&] { return viewer.connections == 2; });
    viewer.finish();
    EXPECT_EQ(viewer.created, 2);
    EXPECT_EQ(warnings, 1);
    expectWholePicture(viewer, *job);
}

TEST_F(WatchedCommand, ADisplayServerChangesNoByte) {
    Viewer viewer;
    const ProgramRun run = runProgram({"render", scene, "-o", picture, "--display-server", viewer.text()});
    EXPECT_EQ(run.code, 0) << run.err;
    viewer.finish();
    EXPECT_TRUE(viewer.name.starts_with(picture + " (")) << viewer.name;
    EXPECT_TRUE(viewer.understoodAll);
    const ExrFile file = readExr(picture);
    EXPECT_TRUE(viewer.channels.at("R") == *file.find("R"));
    EXPECT_TRUE(viewer.channels.at("A") == *file.find("A"));
    const std::string bytes = readBytes(picture);
    ASSERT_EQ(runProgram({"render", scene, "-o", picture, "--quiet"}).code, 0);
    EXPECT_TRUE(bytes == readBytes(picture));

    const ProgramRun alone = runProgram({"render", scene, "-o", picture, "--display-server", viewer.text()});
    EXPECT_EQ(alone.code, 0);
    EXPECT_TRUE(bytes == readBytes(picture));
    EXPECT_TRUE(contains(alone.err, "warning: the display server " + viewer.text() + " cannot be reached: "))
        << alone.err;
}

}  // namespace
}  // namespace penumbra
