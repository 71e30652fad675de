#include "core/device/protocol/frame.h"

#include <gtest/gtest.h>

#include <random>

#include "resources/firmware/skin_frame.h"

namespace skincal {
namespace {

struct Sent {
    FrameHeader header;
    std::string payload;
    friend bool operator==(const Sent&, const Sent&) = default;
};

Sent randomFrame(std::mt19937& random) {
    Sent sent;
    sent.header.incompatible = static_cast<std::uint8_t>(random());
    sent.header.compatible = static_cast<std::uint8_t>(random());
    sent.header.type = static_cast<FrameType>(random() & 0xFF);
    sent.header.sequence = static_cast<std::uint16_t>(random());
    sent.header.epoch = static_cast<std::uint8_t>(random());
    sent.header.direction = static_cast<FrameDirection>(random() % 3);
    sent.header.first = static_cast<std::uint16_t>(random());
    sent.header.count = static_cast<std::uint16_t>(random());
    sent.header.time_us = static_cast<std::uint32_t>(random());
    // Many zeros, none, or anything between.
    const unsigned zeros = random() % 4;
    sent.payload.resize(random() % (kMaxPayload + 1));
    for (char& byte : sent.payload)
        byte = random() % 4 < zeros ? '\0' : static_cast<char>(random());
    return sent;
}

std::vector<Sent> decode(FrameDecoder& decoder, std::span<const std::uint8_t> bytes) {
    std::vector<Sent> received;
    decoder.feed(bytes, [&](const FrameHeader& header, std::string_view payload) {
        received.push_back({header, std::string(payload)});
    });
    return received;
}

TEST(Frame, ComesBackHoweverTheBytesAreCutUp) {
    std::mt19937 random(1);
    std::vector<Sent> sent;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 2000; ++i) {
        sent.push_back(randomFrame(random));
        const std::size_t before = bytes.size();
        appendFrame(sent.back().header, sent.back().payload, bytes);
        ASSERT_LE(bytes.size() - before, kMaxEncodedFrame);
        ASSERT_EQ(bytes.size() - before, kEmptyFrame + sent.back().payload.size());
    }
    FrameDecoder decoder;
    std::vector<Sent> received;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t part = std::min<std::size_t>(1 + random() % 700, bytes.size() - at);
        for (Sent& one : decode(decoder, std::span(bytes).subspan(at, part)))
            received.push_back(std::move(one));
        at += part;
    }
    EXPECT_EQ(received, sent);
    EXPECT_EQ(decoder.counts().frames, sent.size());
    EXPECT_EQ(decoder.counts().damaged, 0);
    EXPECT_EQ(decoder.counts().bytes, bytes.size());
}

TEST(Frame, CellAndComputerWriteTheSameBytesAndReadEachOthers) {
    std::mt19937 random(2);
    skin_receiver receiver{};
    for (int i = 0; i < 2000; ++i) {
        const Sent sent = randomFrame(random);
        std::vector<std::uint8_t> bytes;
        appendFrame(sent.header, sent.payload, bytes);
        const skin_header header{sent.header.version,
                                 sent.header.incompatible,
                                 sent.header.compatible,
                                 static_cast<std::uint8_t>(sent.header.type),
                                 sent.header.sequence,
                                 sent.header.epoch,
                                 static_cast<std::uint8_t>(sent.header.direction),
                                 sent.header.first,
                                 sent.header.count,
                                 sent.header.time_us};
        std::array<std::uint8_t, SKIN_MAX_ENCODED> encoded{};
        const auto* raw = reinterpret_cast<const std::uint8_t*>(sent.payload.data());
        const std::size_t count = skin_frame_encode(&header, raw, sent.payload.size(), encoded.data());
        ASSERT_EQ(std::vector<std::uint8_t>(encoded.begin(), encoded.begin() + static_cast<std::ptrdiff_t>(count)),
                  bytes);

        bool whole = false;
        skin_header back{};
        const std::uint8_t* payload = nullptr;
        std::size_t length = 0;
        for (const std::uint8_t byte : bytes)
            whole = skin_frame_push(&receiver, byte, &back, &payload, &length);
        ASSERT_TRUE(whole);
        EXPECT_EQ(std::string(reinterpret_cast<const char*>(payload), length), sent.payload);
        EXPECT_EQ(back.sequence, sent.header.sequence);
        EXPECT_EQ(back.time_us, sent.header.time_us);
        EXPECT_EQ(back.first, sent.header.first);
    }
}

TEST(Frame, DamageLosesTheDamagedOnesAndNoOthers) {
    std::mt19937 random(3);
    int lost = 0;
    for (int i = 0; i < 3000; ++i) {
        std::vector<Sent> sent;
        std::vector<std::uint8_t> bytes;
        std::vector<std::size_t> ends;
        for (int k = 0; k < 5; ++k) {
            sent.push_back(randomFrame(random));
            appendFrame(sent.back().header, sent.back().payload, bytes);
            ends.push_back(bytes.size());
        }
        const std::size_t place = random() % bytes.size();
        bytes[place] ^= static_cast<std::uint8_t>(1U << random() % 8);
        const auto hit = static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), place) - ends.begin());
        FrameDecoder decoder;
        const std::vector<Sent> received = decode(decoder, bytes);
        // The end of a frame that was hit joins it to the next.
        const std::size_t also = place + 1 == ends[hit] ? hit + 1 : hit;
        std::vector<Sent> expected;
        for (std::size_t k = 0; k < sent.size(); ++k)
            if (k != hit && k != also)
                expected.push_back(sent[k]);
        ASSERT_EQ(received, expected) << "byte " << place << " of round " << i;
        lost += decoder.counts().damaged > 0 ? 1 : 0;
    }
    EXPECT_GT(lost, 2900);
}

TEST(Frame, GarbageIsDroppedInBoundedMemoryAndWhatFollowsIsRead) {
    std::mt19937 random(4);
    FrameDecoder decoder;
    std::vector<std::uint8_t> noise(100'000);
    for (std::uint8_t& byte : noise)
        byte = static_cast<std::uint8_t>(1 + random() % 255);  // never an end
    EXPECT_TRUE(decode(decoder, noise).empty());
    std::vector<std::uint8_t> bytes{0, 0, 0};
    const Sent sent = randomFrame(random);
    appendFrame(sent.header, sent.payload, bytes);
    EXPECT_EQ(decode(decoder, bytes), std::vector{sent});
    EXPECT_EQ(decoder.counts().damaged, 1);
}

TEST(Frame, IsTheExampleOfTheSpecification) {
    FrameHeader header;
    header.compatible = FrameHeader::kReliable | FrameHeader::kFirst;
    header.type = FrameType::Hello;
    header.sequence = 0x1234;
    std::vector<std::uint8_t> bytes;
    appendFrame(header, std::string("\x08\x01\x10\x01\x30\x01", 6), bytes);
    EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x02, 0x01, 0x05, 0x03, 0x0A, 0x34, 0x12, 0x01, 0x01, 0x01,
                                                0x01, 0x01, 0x01, 0x01, 0x01, 0x01, 0x0B, 0x08, 0x01, 0x10,
                                                0x01, 0x30, 0x01, 0x1A, 0x29, 0x34, 0xFE, 0x00}));
}

TEST(Frame, RefusesPayloadsThatAreTooLong) {
    std::vector<std::uint8_t> bytes;
    EXPECT_THROW(appendFrame({}, std::string(kMaxPayload + 1, 'x'), bytes), std::logic_error);
    EXPECT_NO_THROW(appendFrame({}, std::string(kMaxPayload, 'x'), bytes));
    EXPECT_EQ(bytes.size(), kMaxEncodedFrame);
}

}  // namespace
}  // namespace skincal
