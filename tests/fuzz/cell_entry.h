#pragma once

#include <tuple>

#include "resources/firmware/skin_cell.h"
#include "tests/fuzz/made_message.h"

namespace skincal::test {

/// One cell among liars. It is plain data: each input begins with a copy of one that has come so far.
class CellBench {
  public:
    static constexpr int kPorts = 4;
    static constexpr int kStages = 5;

    /// @param stage  0 just booted, 1 being explored, 2 explored, 3 numbered, 4 measuring, streaming and lit
    explicit CellBench(int stage) {
        board_.byte_ns = 3333;
        board_.now_us = [](void* self) { return of(self).now_; };
        board_.send = [](void* self, int port, const std::uint8_t* bytes, std::size_t count) {
            return of(self).sent(port, {bytes, count});
        };
        board_.led = [](void*, std::uint8_t, std::uint8_t, std::uint8_t) {};
        board_.acceleration = [](void*, float xyz[3]) { xyz[0] = xyz[1] = xyz[2] = 1; };
        board_.temperature = [](void*) { return 20.0F; };
        board_.tactile = [](void* self, std::uint16_t* proximity, std::uint16_t force[3]) {
            *proximity = force[0] = force[1] = force[2] = static_cast<std::uint16_t>(of(self).now_);
        };
        settle();
        skin_cell_init(&cell_, &board_, &identity_, kPorts, 4000, 1);
        course_.fill({100, 1, 4, 0});
        if (stage > 0)
            say(0, FrameType::Explore, FrameDirection::Local, "");
        if (stage > 1)
            explore();
        if (stage > 2)
            say(0, FrameType::Assign, FrameDirection::Local, "\x08\x04");
        if (stage > 3)
            keepBusy();
        letPass(1000);
    }
    CellBench(const CellBench& other) { *this = other; }
    CellBench& operator=(const CellBench& other) {
        cell_ = other.cell_;
        board_ = other.board_;
        identity_ = other.identity_;
        now_ = other.now_;
        course_ = other.course_;
        settle();
        return *this;
    }

    void take(std::span<const std::uint8_t> input) {
        ByteSource from(input);
        static std::vector<std::uint8_t> bytes;
        for (int i = 0; i < 40 && !from.isOver(); ++i) {
            ByteSource record = from.record();
            const std::uint8_t what = record.byte();
            if (what >= 224) {
                letPass(static_cast<std::uint32_t>(record.number()) * 1000 + 500);
                continue;
            }
            const int port = what % kPorts;
            course_[static_cast<std::size_t>(port)].now = now_;
            bytes.clear();
            appendArrival(record, course_[static_cast<std::size_t>(port)], bytes);
            const auto orders = [&] {
                return std::tuple(cell_.leds.queued, cell_.leds.word_set, cell_.to_report, cell_.senses.run);
            };
            const auto before = orders();
            const auto [epoch, parent] = std::pair(cell_.tree.epoch, cell_.tree.parent);
            skin_cell_receive(&cell_, port, bytes.data(), bytes.size());
            require(port == parent || cell_.tree.epoch != epoch || orders() == before, "orders of others are obeyed");
            check();
            if (what < 192)
                run(300);
        }
        for (int i = 0; i < 2; ++i)
            letPass(100'000);
    }

    [[nodiscard]] const skin_cell& cell() const { return cell_; }

  private:
    static CellBench& of(void* self) { return *static_cast<CellBench*>(self); }

    void settle() {
        board_.context = this;
        cell_.board = cell_.link.board = &board_;
        cell_.identity = &identity_;
    }

    /// Port 0 leads to the computer, a child with three cells is at 1, a neighbour at 2, nobody at 3.
    void explore() {
        say(1, FrameType::Explored, FrameDirection::Local, "\x08\x01");
        say(2, FrameType::Explored, FrameDirection::Local, "\x10\x03");
        say(1, FrameType::Subtree, FrameDirection::Local, "\x08\x03");
        letPass(500'000);
        require(cell_.tree.reported && cell_.tree.size == 4, "a cell that does not take part");
    }
    void keepBusy() {
        require(cell_.tree.number == 4, "a cell that takes no number");
        say(0, FrameType::Words, FrameDirection::Down, "\x08\x02\x12\x04\x01\x02\x03\x04\x18\x07");
        say(0, FrameType::Pattern, FrameDirection::Down, "\x08\x05\x10\x03\x18\x01\x30\x07");
        say(0, FrameType::Measure, FrameDirection::Down, "\x08\x64\x10\x01");
        say(0, FrameType::Stream, FrameDirection::Down, "\x08\x02\x10\x14\x20\x01");
        say(0, FrameType::Stream, FrameDirection::Down, "\x08\x03\x10\x14\x20\x01");
        letPass(1000);
        require(cell_.leds.has_shown && cell_.senses.measuring, "a cell that does not do what it is told");
    }

    void say(int port, FrameType type, FrameDirection direction, std::string_view payload) {
        Course& course = course_[static_cast<std::size_t>(port)];
        FrameHeader header;
        header.compatible = FrameHeader::kReliable;
        header.type = type;
        header.direction = direction;
        header.sequence = ++course.sequence;
        header.epoch = course.epoch;
        header.first = 4;
        header.count = 2;
        std::vector<std::uint8_t> bytes;
        appendFrame(header, payload, bytes);
        skin_cell_receive(&cell_, port, bytes.data(), bytes.size());
        letPass(1000);
    }

    void letPass(std::uint32_t us) {
        now_ += us;
        run(1000);
    }
    /// As often as the cell wants it, for so long: a main loop that never rests would hang a board.
    void run(std::uint32_t us) {
        int turns = 0;
        for (std::uint32_t wait = skin_cell_run(&cell_); wait <= us; wait = skin_cell_run(&cell_)) {
            now_ += wait;
            us -= wait;
            require(++turns < 100, "a cell that never rests");
        }
        check();
    }

    void check() const {
        const skin_tree& tree = cell_.tree;
        const unsigned parent = tree.parent < 0 ? 0 : 1U << tree.parent;
        require(tree.parent < kPorts, "a parent where there is no port");
        require((tree.children & parent) == 0, "a parent that is a child");
        require((tree.uncounted & ~tree.children) == 0, "somebody else's cells are waited for");
        require((tree.children | tree.open | tree.heard | tree.alive) < 1U << kPorts, "ports that are not there");
        require(tree.number == 0 || (tree.reported && parent != 0), "a number that was not asked for");
        require((cell_.tally.waiting & ~tree.children) == 0 || !cell_.tally.open, "a count of others' cells");
        require(cell_.leds.queued <= SKIN_QUEUED_PATTERNS, "more patterns than there is room for");
        require(cell_.leds.mask < 16, "a mask of more than four bits");
    }

    std::uint32_t sent(int port, std::span<const std::uint8_t> bytes) const {
        static FrameDecoder decoder;
        const std::uint64_t frames = decoder.counts().frames;
        decoder.feed(bytes, [&](const FrameHeader& header, std::string_view) { checkSent(port, header); });
        require(decoder.counts().frames == frames + 1, "a cell that sends no frame");
        return static_cast<std::uint32_t>(bytes.size() * 10 / 3);
    }
    void checkSent(int port, const FrameHeader& header) const {
        const skin_tree& tree = cell_.tree;
        require(header.version == FrameHeader::kVersion && header.incompatible == 0, "a version or flag of no use");
        const bool isLocal = header.direction == FrameDirection::Local;
        const bool isOfExploration = !isLocal || header.type == FrameType::Tallied ||
                                     (header.type >= FrameType::Explore && header.type <= FrameType::Neighbour);
        require(!isOfExploration || header.epoch == tree.epoch, "what belongs to an exploration that has ended");
        const bool isUp = isLocal ? header.type == FrameType::Subtree || header.type == FrameType::Tallied
                                  : header.direction == FrameDirection::Up;
        const bool isDown = isLocal ? header.type == FrameType::Assign : header.direction == FrameDirection::Down;
        require(!isUp || port == tree.parent, "what is for the computer goes elsewhere");
        require(!isDown || (tree.children >> port & 1U), "what is for children goes elsewhere");
    }

    skin_cell cell_{};
    skin_board board_{};
    skin_identity identity_{{1, 2, 3}, "hexagon", "fuzzed", 1, 2};
    std::uint32_t now_ = 1000;
    std::array<Course, kPorts> course_{};
};

/// The first byte says how far the cell has come; records of what it hears follow.
inline void hearAsCell(std::span<const std::uint8_t> input) {
    static const std::array<CellBench, CellBench::kStages> stages{CellBench(0), CellBench(1), CellBench(2),
                                                                  CellBench(3), CellBench(4)};
    static CellBench bench(0);
    if (input.empty())
        return;
    bench = stages[input.front() % stages.size()];
    bench.take(input.subspan(1));
}

}  // namespace skincal::test
