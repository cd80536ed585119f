// The process that decodes for the server: one task after the other, until the server has gone.
#pragma once

namespace qtet {

/// The only argument of the server's program that makes it such a process.
inline constexpr const char* kDecoderArgument = "--decode-for-server";
/// The channel's number there.
inline constexpr int kDecoderChannel = 3;

/// Answers tasks of kDecoderChannel, and ends the process when nobody is at its other end. Call
/// once, before threads.
[[noreturn]] void runDecoder();

}  // namespace qtet
