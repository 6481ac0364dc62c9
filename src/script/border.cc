// The border between C++ and Guile.
//
// Source: the pattern was measured before it was adopted: fourteen kinds of exit, none of which
// skips a destructor.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "script/border.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

#include "base/cpu-clock.h"
#include "kernel/world/callback.h"
#include "script/primitive.h"
#include "script/values.h"

namespace tw {

namespace {

// Scheme procedures that errors.scm and guarded-call.scm install
SCM raise_hook = SCM_BOOL_F;     // (message name value place backtrace) -> never returns
SCM describe_hook = SCM_BOOL_F;  // (key args places) -> #(message place backtrace)
SCM caller = SCM_BOOL_F;         // (procedure argument ...) -> what the procedure returns
SCM escape_hook = SCM_BOOL_F;    // () -> never returns: raises what stands for an escape

int call_depth = 0;
// set only while our catch is in place: then an interrupt may throw
bool interruptible = false;
bool interrupt_requested = false;
// the signal that is to end the program, 0: none but Ctrl-C
int ending_signal = 0;

SCM key_interrupted() {
  static const SCM key = scm_gc_protect_object(scm_from_utf8_symbol("timewarp-interrupted"));
  return key;
}

// Ctrl-C leads to the prompt, a signal that ends the program past it, with the status that a shell
// gives to a program that ends so.  Inside a call there is no prompt: our catch there knows one
// key.
[[noreturn]] void throw_interrupted() {
  static const SCM key_quit = scm_gc_protect_object(scm_from_utf8_symbol("quit"));
  if (ending_signal != 0 && call_depth == 0)
    scm_throw(key_quit, scm_list_1(scm_from_int(128 + ending_signal)));
  scm_throw(key_interrupted(), SCM_EOL);
  std::abort();  // scm_throw does not return
}

struct CallState : Live<LiveKind::border_call> {
  CallState* outer = nullptr;
  SCM procedure;
  std::span<SCM> arguments;
  SCM result = SCM_UNDEFINED;
  SCM places = SCM_EOL, description = SCM_BOOL_F;
  SCM key = SCM_BOOL_F, key_arguments = SCM_EOL;
  bool finished = false;
  bool saw_exception = false;
  bool interrupted = false;  // an interrupt was raised, which the procedure may have caught
};

CallState* innermost_call = nullptr;

// Runs while something unwinds through us; an escape that is no exception becomes one, which lands
// in our own catch, as does the interrupt that came just before guarded-call.scm looks for
// exceptions, or after.
void on_unwind(void* data) {
  auto* state = static_cast<CallState*>(data);
  interruptible = false;
  if (state->finished || state->saw_exception) return;
  if (state->interrupted) scm_throw(key_interrupted(), SCM_EOL);
  scm_call_0(escape_hook);
}

// The procedure goes before its arguments.
SCM call_by_hook(const CallState& state) {
  constexpr std::size_t most = 8;
  const std::size_t count = state.arguments.size();
  if (count <= most) {
    SCM all[1 + most] = {state.procedure};
    std::copy_n(state.arguments.data(), count, all + 1);
    return scm_call_n(caller, all, count + 1);
  }
  SCM list = SCM_EOL;
  for (std::size_t i = count; i-- > 0;) list = scm_cons(state.arguments[i], list);
  return scm_apply_1(caller, state.procedure, list);
}

SCM call_body(void* data) {
  auto* state = static_cast<CallState*>(data);
  scm_dynwind_begin(static_cast<scm_t_dynwind_flags>(0));
  scm_dynwind_unwind_handler(on_unwind, data, static_cast<scm_t_wind_flags>(0));
  interruptible = true;
  state->result = call_by_hook(*state);
  interruptible = false;
  state->finished = true;
  scm_dynwind_end();
  return SCM_UNSPECIFIED;
}

SCM describe_body(void* data) {
  auto* state = static_cast<CallState*>(data);
  state->description = scm_call_3(describe_hook, state->key, state->key_arguments, state->places);
  return SCM_UNSPECIFIED;
}

SCM ignore_handler(void*, SCM, SCM) { return SCM_UNSPECIFIED; }

// guarded-call.scm tells of an exception while the stack still stands: the places that the message
// needs.
SCM call_raised(SCM places) {
  interruptible = false;
  innermost_call->saw_exception = true;
  innermost_call->places = places;
  return SCM_UNSPECIFIED;
}

// the stack is unwound: the message is made
SCM on_caught(void* data, SCM key, SCM arguments) {
  auto* state = static_cast<CallState*>(data);
  interruptible = false;
  state->key = key;
  state->key_arguments = arguments;
  if (!scm_is_eq(key, key_interrupted()))
    scm_c_catch(SCM_BOOL_T, describe_body, data, ignore_handler, nullptr, nullptr, nullptr);
  return SCM_UNSPECIFIED;
}

void* call_caught(void* data) {
  scm_c_catch(SCM_BOOL_T, call_body, data, on_caught, data, nullptr, nullptr);
  return data;
}

// Guile's own barrier sets the root of continuations and catches everything, which our catch does
// already, better: half the cost of a call.  Where Guile shows its threads' roots, they are set
// here as it sets them, so that no continuation of a call is entered from another one.
template <class Thread>
concept ShowsRoot = requires(Thread thread) {
  thread.continuation_root = SCM_EOL;
  thread.continuation_base = static_cast<SCM_STACKITEM*>(nullptr);
  thread.handle;
};

template <class Thread>
void call_barrier(CallState& state) {
  if constexpr (ShowsRoot<Thread>) {
    SCM_STACKITEM base{};
    // one thread enters the kernel; the pointer is looked for once for each
    thread_local Thread* const thread =
        reinterpret_cast<Thread*>(SCM_SMOB_DATA(scm_current_thread()));
    const SCM outer_root = thread->continuation_root;
    SCM_STACKITEM* const outer_base = thread->continuation_base;
    thread->continuation_root = scm_cons(thread->handle, outer_root);
    thread->continuation_base = &base;
    call_caught(&state);
    thread->continuation_base = outer_base;
    thread->continuation_root = outer_root;
  } else {
    scm_c_with_continuation_barrier(call_caught, &state);
  }
}

Place place_of(SCM place) { return is_place(place) ? to_place(place) : Place{}; }

[[noreturn]] void throw_described(const CallState& state) {
  // where the stack of C is full Guile unwinds first: nothing could be described
  static const SCM key_overflow = scm_gc_protect_object(scm_from_utf8_symbol("stack-overflow"));
  if (scm_is_eq(state.key, key_overflow))
    throw SchemeError(
        "a procedure calls itself without end, or too often; expected a recursion that ends", {},
        "");
  const SCM d = state.description;
  if (!scm_is_vector(d) || SCM_SIMPLE_VECTOR_LENGTH(d) != 3)
    throw SchemeError("a Scheme procedure failed, and so did describing its error", {}, "");
  throw SchemeError(text_of(SCM_SIMPLE_VECTOR_REF(d, 0)), place_of(SCM_SIMPLE_VECTOR_REF(d, 1)),
                    text_of(SCM_SIMPLE_VECTOR_REF(d, 2)));
}

void set_pending(PendingError& pending, const std::string& message, const Place& place,
                 const std::string& backtrace) {
  pending.raised = true;
  pending.message = from_string(message);
  pending.place = from_place(place);
  pending.backtrace = from_string(backtrace);
}

}  // namespace

SCM call_scheme(SCM procedure, std::span<SCM> arguments) {
  ++guile_calls;
  CallState state;
  state.procedure = procedure;
  state.arguments = arguments;
  state.outer = innermost_call;
  innermost_call = &state;
  ++call_depth;
  const bool outer_interruptible = interruptible;
  call_barrier<scm_thread>(state);
  interruptible = outer_interruptible;
  --call_depth;
  innermost_call = state.outer;
  if (state.finished) return state.result;
  if (scm_is_eq(state.key, key_interrupted())) throw Interrupted();
  throw_described(state);
}

void look_for_signals() {
  constexpr double between_looks = 0.04;  // s: the prompt is to be back within 0.1
  static double last = 0;
  const double now = wall_seconds();
  if (now - last < between_looks) return;
  last = now;
  static const SCM tick = scm_gc_protect_object(
      scm_c_make_gsubr("%tick", 0, 0, 0, reinterpret_cast<scm_t_subr>(+[]() -> SCM {
                         scm_async_tick();
                         return SCM_UNSPECIFIED;
                       })));
  call_scheme(tick, {});
  // nobody's procedure: it does not count
  --guile_calls;
}

bool inside_call() { return call_depth > 0; }

void require_outside_callbacks(const char* what) {
  TW_REQUIRE(!inside_call(),
             std::string(what) +
                 " was used inside a callback or observer; expected only what the procedure is "
                 "handed there, through its views");
}

PendingError run_catching(SCM (*body)(void*), void* data, SCM* result) noexcept {
  PendingError pending;
  try {
    *result = body(data);
  } catch (const BadValue& bad) {
    set_pending(pending, bad.expected, {}, "");
    pending.name = from_string(bad.name);
    pending.value = bad.value;
  } catch (const SchemeError& error) {
    set_pending(pending, error.what(), error.place(), error.backtrace());
  } catch (const UserError& error) {
    set_pending(pending, error.what(), error.place(), "");
  } catch (const Interrupted&) {
    pending.raised = true;
    pending.message = key_interrupted();
  } catch (const std::exception& error) {
    set_pending(pending, std::string("internal error: ") + error.what(), {}, "");
  }
  return pending;
}

void raise_pending(const PendingError& error) {
  if (scm_is_eq(error.message, key_interrupted())) throw_interrupted();
  scm_call_5(raise_hook, error.message, error.name, error.value, error.place, error.backtrace);
  std::abort();  // the hook does not return
}

TW_PRIMITIVES(define_border)

TW_PRIMITIVE(set_raise_hook, "%set-raise-hook!", (SCM raise),
             "Install the procedure that raises errors.") {
  raise_hook = scm_gc_protect_object(raise);
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(set_call_hooks, "%set-call-hooks!", (SCM call, SCM escape, SCM describe),
             "Install the procedures that call the user's, stop escapes and describe errors.") {
  caller = scm_gc_protect_object(call);
  escape_hook = scm_gc_protect_object(escape);
  describe_hook = scm_gc_protect_object(describe);
  return SCM_UNSPECIFIED;
}

// Called by the handlers of signals.  Throws where nothing of C++ is on the stack between here and
// a catch of ours; elsewhere it leaves a note for the next slice.
static SCM interrupt(SCM signal) {
  const int number = scm_to_int(signal);
  if (number != SIGINT) ending_signal = number;
  if (call_depth > 0 && interruptible) innermost_call->interrupted = true;
  if (call_depth == 0 || interruptible) throw_interrupted();
  interrupt_requested = true;
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(forget_interrupt, "%forget-interrupt!", (),
             "Forget an interrupt that is waiting, unless it ends the program.") {
  interrupt_requested = false;
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(check_interrupt, "%check-interrupt!", (), "Raise an interrupt that is waiting.") {
  if (!interrupt_requested && ending_signal == 0) return SCM_UNSPECIFIED;
  interrupt_requested = false;
  throw Interrupted();
}

TW_PRIMITIVE(is_reader_gone, "%reader-gone?", (),
             "Is standard output or standard error a pipe that nobody reads any more?") {
  pollfd files[] = {{STDOUT_FILENO, 0, 0}, {STDERR_FILENO, 0, 0}};
  poll(files, 2, 0);
  return scm_from_bool(((files[0].revents | files[1].revents) & POLLERR) != 0);
}

TW_PRIMITIVE(is_inside_call, "%inside-callback?", (), "Is a callback or observer running?") {
  return scm_from_bool(inside_call());
}

TW_PRIMITIVE(check_outside, "%require-outside-callbacks", (SCM what),
             "Raise an error if a callback or observer is running; WHAT was asked for.") {
  require_outside_callbacks(text_of(what).c_str());
  return SCM_UNSPECIFIED;
}

TW_PRIMITIVE(live_objects, "%live-objects", (),
             "Return an alist of the numbers of living C++ objects by kind.") {
  SCM list = SCM_EOL;
  for (int i = live_kinds - 1; i >= 0; --i) {
    const auto k = static_cast<std::size_t>(i);
    list = scm_acons(scm_from_utf8_symbol(live_names[k]), scm_from_int64(live_counts[k]), list);
  }
  return list;
}

TW_PRIMITIVE(count_guile_calls, "%guile-calls", (),
             "Return the number of calls from C++ into Guile.") {
  return scm_from_int64(guile_calls);
}

void define_exits() {
  const auto define = [](const char* name, SCM (*function)(SCM)) {
    scm_c_define_gsubr(name, 1, 0, 0, reinterpret_cast<scm_t_subr>(function));
    scm_c_export(name, nullptr);
  };
  define("%interrupt!", interrupt);
  define("%call-raised!", call_raised);
}

}  // namespace tw
