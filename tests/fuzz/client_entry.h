#pragma once

#include <memory>
#include <set>

#include "core/device/protocol/skin_client.h"
#include "resources/firmware/skin_frame.h"
#include "tests/fuzz/made_message.h"

namespace skincal::test {

/// Believes nothing that a client tells it unless it can be.
class Sceptic : public SkinListener {
  public:
    void onOpened(const std::string&) override {}
    void onFault(SkinFault) override { cells_ = 0; }
    void onCounted(std::size_t cells) override {
        require(cells > 0 && cells < 0xFFFF, "a number of cells that numbers don't reach to");
        cells_ = cells;
        known_.clear();
    }
    void onCell(const NetworkCell& cell) override {
        require(isThere(cell.number) && cell.uniqueId.size() == 24, "a cell that was not counted");
        require(known_.insert(cell.number).second, "a cell that is new twice");
    }
    void onExplored(const SkinNetwork& network) override {
        require(network.cells.size() == known_.size() && known_.size() + network.missing.size() == cells_,
                "cells that are neither described nor missing");
        for (const NetworkCell& cell : network.cells) {
            require(known_.contains(cell.number), "a cell that nobody heard of");
            for (const NetworkCell::Heard& heard : cell.heard)
                require(heard.port >= 0 && heard.port < cell.ports && heard.port_there >= 0 && heard.cell <= cells_,
                        "a link to nowhere");
        }
        for (const CellNumber cell : network.missing)
            require(isThere(cell) && !known_.contains(cell), "a missing cell that is there");
    }
    void onRestarted() override {}
    void onShown(std::uint64_t token) override { answerLight(token); }
    void onNotShown(std::uint64_t token, std::span<const CellNumber>) override { answerLight(token); }
    void onAcceleration(const RestReading& reading, Time) override { checkReading(reading); }
    void onRest(std::span<const RestReading> readings, std::span<const CellNumber> missing) override {
        std::set<CellNumber> there;
        for (const RestReading& reading : readings) {
            checkReading(reading);
            require(there.insert(reading.cell).second, "two readings of one cell");
        }
        for (const CellNumber cell : missing)
            require(there.insert(cell).second, "a reading of a cell that gave none");
    }
    void onTouch(std::span<const CellTouch> touches, Time) override {
        for (const CellTouch& touch : touches)
            require(isThere(touch.cell) && touch.proximity >= 0 && touch.proximity <= 1, "touch of nobody");
    }

    void lights(std::uint64_t token) { awaited_ = token; }

  private:
    [[nodiscard]] bool isThere(CellNumber cell) const { return cell > 0 && cell <= cells_; }
    void checkReading(const RestReading& reading) const {
        require(isThere(reading.cell) && reading.count > 0 && reading.mean.allFinite() && reading.variance.allFinite(),
                "a reading that can't be");
    }
    void answerLight(std::uint64_t token) {
        require(token != 0 && token == awaited_, "an answer to what was not asked");
        awaited_ = 0;
    }

    std::size_t cells_ = 0;
    std::set<CellNumber> known_;
    std::uint64_t awaited_ = 0;
};

/// A computer whose skin lies. Each input begins with a copy of a client that has come so far.
class ClientBench {
  public:
    static constexpr int kStages = 5;
    using Time = SkinClient::Time;

    /// @param stage  0 greeting, 1 exploring, 2 asking four cells who they are, 3 they are known, 4 lit and measuring
    explicit ClientBench(int stage) : client_(sceptic(), {}, 0) {
        course_ = {100, 0, 1, 0};
        sceptic() = {};
        client_.open(now_);
        run();
        if (stage > 0)
            comeTo(stage);
        known_ = sceptic();
    }
    ClientBench(const ClientBench& other) = default;

    void take(ByteSource from) {
        sceptic() = known_;
        static std::vector<std::uint8_t> bytes;
        for (int i = 0; i < 40 && !from.isOver(); ++i) {
            ByteSource record = from.record();
            const std::uint8_t what = record.byte();
            if (what >= 224) {
                now_ += Time(static_cast<std::uint32_t>(record.number() & 0xFF) * 50'000 + 500);
                run();
            } else if (what >= 192) {
                order(what, record);
            } else {
                course_.now = static_cast<std::uint32_t>(now_.count());
                bytes.clear();
                appendArrival(record, course_, bytes);
                client_.receive(bytes, now_);
            }
            if (what % 2 == 0)
                run();
        }
        for (int i = 0; i < 8; ++i) {
            now_ += Time(100'000);
            run();
        }
    }

  private:
    /// A client tells its listener, the same for all copies.
    static Sceptic& sceptic() {
        static Sceptic one;
        return one;
    }

    void comeTo(int stage) {
        say(FrameType::Hello, 0, "\x08\x01\x10\x01");
        client_.explore(now_);
        course_.epoch = 1;
        if (stage > 1)
            say(FrameType::Subtree, 0, "\x08\x04");
        for (std::uint16_t cell = 1; cell <= 4 && stage > 2; ++cell)
            say(FrameType::CellInfo, cell, "\x0A\x0Cuniqueid0000\x12\x03hex\x18\x04");
        if (stage > 3) {
            client_.prepare({{{1, 7}, {3, 7}}, {{2, 7}}});
            light(1);
            client_.measureRest(std::chrono::milliseconds(20), now_);
        }
        run();
    }

    void order(std::uint8_t what, ByteSource& record) {
        switch (what % 8) {
            case 0:
            case 1:
                light(record.byte());
                break;
            case 2:
            case 3:
                client_.measureRest(std::chrono::milliseconds(record.byte()), now_);
                break;
            case 4: {
                const std::chrono::milliseconds period(record.byte());
                client_.streamTouch(period, record.byte() % 100);
                break;
            }
            case 5:
                client_.streamRest(std::chrono::milliseconds(record.byte()));
                break;
            case 6:
                client_.prepare({{{1, 7}}, {{2, 7}, {static_cast<CellNumber>(3 + record.below(4)), 7}}});
                break;
            default:
                client_.explore(now_);
                break;
        }
    }
    /// Nobody, all of four, one, a set that was prepared or another; in one colour or two.
    void light(std::uint8_t which) {
        std::vector<LitCell> lit;
        for (CellNumber cell = 1; cell <= 4; ++cell)
            if (which >> (cell - 1) & 1U)
                lit.push_back({cell, static_cast<std::uint8_t>(which & 0x80U && cell == 2 ? 1 : 7)});
        sceptic().lights(++token_);
        client_.light(lit, token_, now_);
    }

    void say(FrameType type, std::uint16_t upFrom, std::string_view payload) {
        FrameHeader header;
        header.compatible = FrameHeader::kReliable;
        header.type = type;
        header.sequence = ++course_.sequence;
        header.epoch = course_.epoch;
        header.direction = upFrom == 0 ? FrameDirection::Local : FrameDirection::Up;
        header.first = upFrom;
        header.count = 1;
        std::vector<std::uint8_t> bytes;
        appendFrame(header, payload, bytes);
        client_.receive(bytes, now_);
        run();
    }

    void run() {
        static std::vector<std::uint8_t> bytes;
        bytes.clear();
        client_.poll(now_, bytes);
        // 4 ms of the line and what one frame exceeds them by, an acknowledgement besides.
        require(bytes.size() < 2000, "more than the line carries");
        require(client_.link().waiting() < 20'000, "a queue without end");
        static skin_receiver receiver;
        std::size_t frames = 0;
        std::size_t ends = 0;
        for (const std::uint8_t byte : bytes) {
            skin_header header;
            const std::uint8_t* payload = nullptr;
            std::size_t length = 0;
            ends += byte == 0;
            if (skin_frame_push(&receiver, byte, &header, &payload, &length)) {
                ++frames;
                // Cells answer as of the exploration that they are told of.
                if (header.type == static_cast<std::uint8_t>(FrameType::Explore))
                    course_.epoch = header.epoch;
            }
        }
        require(frames == ends, "a computer that sends what is no frame");
    }

    Sceptic known_;  ///< what the listener knows by now
    SkinClient client_;
    Course course_;
    Time now_{1000};
    std::uint64_t token_ = 0;
};

/// The first byte says how far the client has come; records of what it hears and is asked to do follow.
inline void hearAsComputer(std::span<const std::uint8_t> input) {
    if (input.empty())
        return;
    static const auto stages = [] {
        std::array<std::unique_ptr<ClientBench>, ClientBench::kStages> made;
        for (int stage = 0; stage < ClientBench::kStages; ++stage)
            made[static_cast<std::size_t>(stage)] = std::make_unique<ClientBench>(stage);
        return made;
    }();
    ClientBench bench(*stages[input.front() % stages.size()]);
    bench.take(ByteSource(input.subspan(1)));
}

}  // namespace skincal::test
