// libFuzzer on a client's input: the bytes of one connection, through a real socket into the framing of requests, whole
// and cut at random. Checks: the parsed requests do not depend on the cuts; nothing is read after a refusal; no body is
// longer than its limit.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

#include "tests/server/http/cut_bytes.h"

namespace {

using namespace tunewright::server::http;

constexpr std::size_t kMaxBody = 3000;
constexpr std::size_t kMaxStreamedBody = 5000;

void require(bool holds, const char* what, const std::string& detail = "") {
    if (holds) return;
    std::cerr << "broken promise: " << what << "\n" << detail << "\n";
    std::abort();
}

/// Writes the parsed data of one request; false if the connection ends.
bool read_request(Connection& connection, std::string& text) {
    std::optional<Head> head = connection.next_head();
    if (!head) return false;
    const bool streamed = head->clean.find(" /s") != std::string::npos;
    if (head->state == Head::State::complete) refuse_body(*head, streamed, streamed ? kMaxStreamedBody : kMaxBody);
    if (head->state == Head::State::refused) {
        text += "refused " + std::to_string(head->status);
        return false;
    }
    require(streamed || head->transfer == Head::Transfer::length, "chunks only where bodies are streamed");
    connection.start(*head, head->clean);
    connection.expect_body(streamed);
    std::string body;
    const bool whole = read_body(connection, body);
    require(body.starts_with(head->clean), "the library reads the head first");
    require(body.size() - head->clean.size() <= (streamed ? kMaxStreamedBody : kMaxBody), "a body within its limit");
    for (const auto& [name, value] : head->fields) text += name + ":" + value + "|";
    text += body + "\n";
    if (!whole) text += "failed " + std::to_string(connection.failed_status());
    return whole && head->keep_alive;
}

template <class Cut>
std::string understood(std::string_view bytes, const Cut& next_size) {
    ServerLimits limits;
    limits.max_batch_body = kMaxStreamedBody;
    const CutBytes client(bytes, next_size);
    Connection connection(client.socket(), "", "", limits);
    std::string text;
    while (read_request(connection, text)) {
    }
    return text;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1 || size > 40'000) return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const std::string whole = understood(bytes, [&] { return bytes.size(); });
    std::minstd_rand random(data[0] + 1U);
    // The socket holds about 270 packets.
    const std::size_t longest = size / 60 + 1 + random() % 60;
    const std::string cut = understood(bytes, [&] { return longest / 2 + 1 + random() % longest; });
    require(cut == whole, "the same however the bytes are cut", "whole: " + whole + "\ncut: " + cut);
    return 0;
}
