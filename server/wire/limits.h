// What the server allows a client, and itself: every bound with its unit and its reason.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace qtet::limits {

using namespace std::chrono_literals;

// ---- connections

/// Connections at a time, HTTP and WebSocket together: 3 KB (HTTP) or 7 KB (WebSocket) each when
/// idle (measured), 28 MB in all, more with TLS; and below the usual hard limit of 4,096 or more
/// open files once some are set aside for the logs.
inline constexpr std::size_t kMaxConnections = 4000;
/// Connections at a time of one address: browsers open 6 and one WebSocket a page; a company behind
/// one address has some pages open.
inline constexpr std::size_t kMaxConnectionsPerAddress = 256;
/// Requests a second of one address: somebody who reads a log chunk by chunk (16 KB and more) comes
/// to 30 MB/s.
inline constexpr unsigned kMaxRequestsPerSecond = 2000;
/// Addresses remembered before those that do nothing are forgotten: 150 bytes each.
inline constexpr std::size_t kMaxRememberedAddresses = 100'000;
/// Seconds after which a client that was turned away (503) is asked to come back.
inline constexpr unsigned kRetryAfterSeconds = 2;
/// How long `accept` rests when the system has no file or memory left for one more connection:
/// after the first failure, and while they go on.
inline constexpr auto kFirstAcceptRest = 1ms;
inline constexpr auto kAcceptRest = 100ms;
/// How often that is told.
inline constexpr auto kAcceptWarningInterval = 10s;

// ---- TLS

/// Handshakes under way, from the server's answer to the hello until the client's last word: 43 KB
/// each (measured), 22 MB in all; who comes later waits in line, which holds nothing but the
/// connection.
inline constexpr std::size_t kMaxHandshakes = 512;
/// How long a handshake keeps its place when others want it: a round trip of a poor line with a
/// packet lost and sent again.
inline constexpr auto kHandshakePatience = 3s;

// ---- HTTP

/// Bytes of a request's line and headers: browsers send under 2 KB, proxies add some.
inline constexpr std::uint32_t kMaxHeaderBytes = 16u << 10;
/// Lines of a request's head: browsers send 15 to 20, proxies add some.
inline constexpr std::size_t kMaxHeaderLines = 100;
/// From a request's first byte to the end of its headers; ends what a slow sender (deliberately or
/// not) can hold.
inline constexpr auto kHeaderTime = 10s;
/// Bytes of a request's body that must arrive within kBodyTime each: so a slow line is served (2
/// KB/s suffice), a dead one is not.
inline constexpr std::size_t kBodyPiece = 64u << 10;
inline constexpr auto kBodyTime = 30s;
/// A kept-alive connection without a request: above the 60 s that common proxies keep theirs, so
/// that they close first.
inline constexpr auto kIdleTime = 75s;
/// Bytes given to one write, each of which must be taken within kWriteTime: so a slow line is
/// served (9 KB/s suffice), a dead one is not.
inline constexpr std::size_t kWritePiece = 256u << 10;
inline constexpr auto kWriteTime = 30s;
/// Bytes of a log from which on the kernel sends them out of the file, and how many at once before
/// other connections have their turn.
inline constexpr std::size_t kLeastFromFile = 16u << 10;
inline constexpr std::size_t kMaxFromFile = 1u << 20;
/// After a refusal that closes, how long and how much is still read, so that the answer is not lost
/// to a reset.
inline constexpr auto kLingerTime = 1s;
inline constexpr std::size_t kLingerBytes = 1u << 20;

// ---- the store

/// Logs held open beside those that are being read, a descriptor and a mapping each: as many as are
/// popular at a time. Opening another takes a millisecond or so.
inline constexpr std::size_t kMaxOpenLogs = 256;
/// How long one look at a folder goes on looking into files, and how many are looked into however
/// long it takes: the start waits for it, a folder of 100,000 logs is read in many looks.
inline constexpr auto kFolderReadTime = 1s;
inline constexpr std::size_t kLogsReadAtOnce = 64;
/// Between them.
inline constexpr auto kFolderReadRest = 50ms;
/// Logs that came at a time and are told of one by one.
inline constexpr std::size_t kMaxLoggedMeshes = 20;
/// Meshes of one page of the list: about 1 KB each.
inline constexpr std::size_t kMaxListPage = 1000;
/// Bytes of a mesh's name: with `.qtet` and what an upload appends, below the 255 that file systems
/// allow.
inline constexpr std::size_t kMaxIdBytes = 150;
/// Bytes of one log that is served from a nameless copy, and of all of them: people copy files over
/// others in place, which changes a mapping under its digest. Most logs are smaller; larger ones
/// are replaced by renaming (`qtet`, uploads).
inline constexpr std::uintmax_t kMaxCopiedLogBytes = 64u << 20;
inline constexpr std::uintmax_t kMaxCopiedBytes = 1u << 30;
/// How long, and how many, replaced logs are still to be had under their digests, for those who are
/// reading them piece by piece.
inline constexpr auto kReplacedLogTime = 10min;
inline constexpr std::size_t kMaxReplacedLogs = 16;
/// How long the folder must be quiet before it is read again: a copy tells of itself many times.
inline constexpr auto kFolderRest = 200ms;
/// Of them at most before a folder that never rests is read all the same.
inline constexpr int kMaxFolderRests = 25;
/// It is read this often in any case, for folders on a network that tell nothing, and to let
/// replaced logs go.
inline constexpr auto kFolderInterval = 60s;

// ---- levels

/// Levels being made or waiting at a time: one that waits holds its log open, one that is made a
/// whole mesh in memory.
inline constexpr std::size_t kMaxLevelJobs = 64;
/// Of them that one address may want: a browser's connections to one server are six, so that no
/// page is refused, and other addresses find places all the same.
inline constexpr std::size_t kMaxLevelJobsPerAddress = 6;
/// Threads that make them, beside the I/O threads.
inline constexpr std::size_t kLevelThreads = 1;
/// Bytes of finished levels kept on disk: some hundred of a mesh of a million cells.
inline constexpr std::uintmax_t kMaxCacheBytes = std::uintmax_t{2} << 30;

/// Tetrahedra of a log whose packets' values are looked at for a view with an isovalue: its finest
/// mesh takes 100 to 150 bytes each, 3 GB in all.
inline constexpr std::uint32_t kMaxIntervalTetrahedra = 20'000'000;

// ---- uploads

/// Bytes of one log that is taken: the format's own end is at 16 GB or so (proto/limits.h,
/// kMaxChunks).
inline constexpr std::uintmax_t kMaxUploadBytes = std::uintmax_t{16} << 30;
/// Uploads at a time, those that wait for their check included: each holds a file and 64 KB. And of
/// one token: a client that trickles its bytes keeps nobody else out.
inline constexpr std::size_t kMaxUploads = 32;
inline constexpr std::size_t kMaxUploadsOfToken = 4;
/// Parts that are kept for going on with them, with the one that comes, and their bytes: two of the
/// largest logs for one token, and for all together as much as four tokens may have.
inline constexpr std::size_t kMaxParts = 32;
inline constexpr std::size_t kMaxPartsOfToken = 8;
inline constexpr std::uintmax_t kMaxPartBytes = std::uintmax_t{128} << 30;
inline constexpr std::uintmax_t kMaxPartBytesOfToken = std::uintmax_t{32} << 30;
/// Bytes of a disk below which no upload is begun and no level is kept: for the access log, and for
/// what else lives there.
inline constexpr std::uintmax_t kDiskReserve = std::uintmax_t{256} << 20;
/// Threads that check what came, decoding it whole, beside those that make levels.
inline constexpr std::size_t kCheckThreads = 1;
/// Bytes of memory that one check may take, as codec/log/decoding_memory.h foretells them: 80 each
/// for a log of 50 million tetrahedra with a field.
inline constexpr std::uintmax_t kMaxCheckBytes = std::uintmax_t{4} << 30;
/// From a check's beginning to its end: so many tetrahedra take a minute.
inline constexpr auto kCheckTime = 10min;
/// What came of an upload that broke off is kept so long for going on with it.
inline constexpr auto kPartialUploadTime = 24h;

// ---- tokens

/// Bytes of the file of tokens.
inline constexpr std::size_t kMaxTokenFileBytes = 1u << 20;
/// From asking for a ticket to the handshake that uses it: one round trip, also of a slow line.
inline constexpr auto kTicketTime = 30s;
/// Unused tickets of one token: a page needs one at a time.
inline constexpr std::size_t kMaxTickets = 256;

// ---- the viewer's files, held in memory

/// Files: the built viewer has about twenty.
inline constexpr std::size_t kMaxViewerFiles = 1000;
/// Bytes of all of them: the built viewer has about one MiB.
inline constexpr std::uintmax_t kMaxViewerBytes = 64u << 20;

// ---- WebSocket

/// Messages a second: a client that grants credit for every block of 16 KB reaches it at 32 MB/s.
inline constexpr unsigned kMaxMessagesPerSecond = 2000;
/// `open`s a second: each makes a plan over the whole chunk table; a person cannot choose fields as
/// fast.
inline constexpr unsigned kMaxOpensPerSecond = 50;
/// `view`s, `target`s and `resume`s with `have` a second: each makes a plan, too; nobody turns a
/// picture faster than a screen of 240 Hz shows it.
inline constexpr unsigned kMaxViewRequestsPerSecond = 250;
/// Answers waiting for a client that sends but does not read.
inline constexpr std::size_t kMaxQueuedAnswers = 256;
/// Fragments of one message: nobody needs more than one for 64 KiB.
inline constexpr std::size_t kMaxFragments = 256;
/// Pings a second: browsers send none.
inline constexpr unsigned kMaxPingsPerSecond = 20;
/// Frames of one write, and payload bytes behind which no further frame joins it: a system call a
/// chunk costs as much as the chunk; what has been given away belongs to the old order when a view
/// changes.
inline constexpr std::size_t kFramesPerWrite = 16;
inline constexpr std::size_t kBytesPerWrite = 128u << 10;
/// Bytes of a frame's payload beyond which no further block is put into it: frequent enough for
/// progress on a slow line (2 s at 1 Mbit/s), large enough that the cost of a frame vanishes.
inline constexpr std::uint32_t kFramePayload = 256u << 10;
/// How long a client may take to close behind the server's closing: within the grace time of the
/// server's end.
inline constexpr auto kClosingTime = 5s;
/// Silence after which a client is given up; a ping goes out at half of it.
inline constexpr auto kSilenceTime = 30s;

// ---- the end

/// From SIGTERM to the end: what responses under way, and closing handshakes, have left. Below the
/// 10 s of common supervisors.
inline constexpr auto kGraceTime = 8s;

}  // namespace qtet::limits
