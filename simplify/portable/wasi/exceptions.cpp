// Exceptions in WebAssembly: what libc++abi and libunwind define where they are built with them.
// Debian's archives for wasm32-wasi are built without.
// https://itanium-cxx-abi.github.io/cxx-abi/abi-eh.html says what the functions do. The compiler
// itself has three names more for WebAssembly: a landing pad fills __wasm_lpad_context, calls
// _Unwind_CallPersonality, and reads which handler it is to run.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <new>
#include <typeinfo>

namespace {

/// It stands before a thrown object.
struct alignas(16) Thrown {
  const std::type_info* type;
  void* (*destroy)(void*);
  Thrown* caughtBefore;
  void* caught;  ///< the object, or the base of it that its handler names
  int handlers;  ///< negative: it is being thrown again
};

Thrown* lastCaught = nullptr;

Thrown& headerOf(void* object) { return static_cast<Thrown*>(object)[-1]; }

/// libc++abi's own types of types; its archive has the virtual functions.
class KnownType : public std::type_info {
 public:
  virtual void unused1() const = 0;
  virtual void unused2() const = 0;
  /// Moves `object` to the base that is caught.
  virtual bool can_catch(const KnownType* thrown, void*& object) const = 0;
};

/// A number of LEB128, without its sign's bits; `bits` gets how many it has.
std::uint32_t rawNumber(const std::uint8_t*& at, unsigned& bits) {
  std::uint32_t out = 0;
  std::uint8_t byte = 0;
  bits = 0;
  do {
    byte = *at++;
    out |= static_cast<std::uint32_t>(byte & 0x7f) << bits;
    bits += 7;
  } while ((byte & 0x80) != 0);
  return out;
}

std::uint32_t unsignedNumber(const std::uint8_t*& at) {
  unsigned bits = 0;
  return rawNumber(at, bits);
}

std::int32_t signedNumber(const std::uint8_t*& at) {
  unsigned bits = 0;
  std::uint32_t out = rawNumber(at, bits);
  if (bits < 32 && (out >> (bits - 1) & 1) != 0) out |= ~0u << bits;
  return static_cast<std::int32_t>(out);
}

}  // namespace

/// That of the C++ library ends the program where memory runs out. Its other forms call this one.
void* operator new(std::size_t bytes) {
  void* memory = std::malloc(bytes == 0 ? 1 : bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

extern "C" {

/// A landing pad says where it is, and reads which of its handlers takes the object.
struct LandingPad {
  std::uint32_t number;
  const std::uint8_t* table;
  std::uint32_t handler;
} __wasm_lpad_context{};

/// Reads the table of a landing pad (LSDA): one entry a pad, a chain of actions each.
int _Unwind_CallPersonality(void* object) {
  constexpr std::uint8_t kOmitted = 0xff;
  LandingPad& pad = __wasm_lpad_context;
  pad.handler = 0;
  const std::uint8_t* at = pad.table;
  if (at == nullptr) return 0;
  if (*at++ != kOmitted) __builtin_trap();  // pads start at the function
  const std::uint8_t* types = nullptr;
  if (*at++ != kOmitted) {
    const std::uint32_t behind = unsignedNumber(at);
    types = at + behind;
  }
  ++at;  // pads are ULEB128
  const std::uint32_t bytes = unsignedNumber(at);
  const std::uint8_t* actions = at + bytes;
  std::uint32_t action = 0;
  for (std::uint32_t i = 0; i <= pad.number; ++i) {
    unsignedNumber(at);
    action = unsignedNumber(at);
  }
  if (action == 0) return 0;
  Thrown& thrown = headerOf(object);
  for (const std::uint8_t* next = actions + action - 1;;) {
    const std::int32_t index = signedNumber(next);
    const std::uint8_t* from = next;
    const std::int32_t step = signedNumber(next);
    if (index > 0) {
      const auto* type = reinterpret_cast<const KnownType* const*>(types)[-index];
      void* caught = object;
      if (type == nullptr || type->can_catch(static_cast<const KnownType*>(thrown.type), caught)) {
        thrown.caught = caught;
        pad.handler = static_cast<std::uint32_t>(index);
        return 0;
      }
    }
    if (step == 0) return 0;
    next = from + step;
  }
}

void* __cxa_allocate_exception(std::size_t bytes) {
  void* memory = std::malloc(sizeof(Thrown) + bytes);
  if (memory == nullptr) std::terminate();
  return new (memory) Thrown{} + 1;
}

void __cxa_free_exception(void* object) { std::free(&headerOf(object)); }

[[noreturn]] void __cxa_throw(void* object, std::type_info* type, void* (*destroy)(void*)) {
  Thrown& thrown = headerOf(object);
  thrown.type = type;
  thrown.destroy = destroy;
  thrown.caught = object;
  __builtin_wasm_throw(0, object);
}

void* __cxa_get_exception_ptr(void* object) { return headerOf(object).caught; }

void* __cxa_begin_catch(void* object) {
  Thrown& thrown = headerOf(object);
  thrown.handlers = std::abs(thrown.handlers) + 1;
  if (lastCaught != &thrown) {
    thrown.caughtBefore = lastCaught;
    lastCaught = &thrown;
  }
  return thrown.caught;
}

void __cxa_end_catch() {
  Thrown* thrown = lastCaught;
  if (thrown == nullptr) return;
  if (thrown->handlers < 0) {  // thrown again: it lives
    if (++thrown->handlers == 0) lastCaught = thrown->caughtBefore;
    return;
  }
  if (--thrown->handlers > 0) return;
  lastCaught = thrown->caughtBefore;
  if (thrown->destroy != nullptr) thrown->destroy(thrown + 1);
  std::free(thrown);
}

[[noreturn]] void __cxa_rethrow() {
  if (lastCaught == nullptr) std::terminate();
  lastCaught->handlers = -lastCaught->handlers;
  __builtin_wasm_throw(0, lastCaught + 1);
}

}  // extern "C"
