# SPDX-License-Identifier: Apache-2.0
"""The attacks of the campaign, by name: what is started, when, and how the plant is set up."""
import dataclasses
import os
import signal
import time


@dataclasses.dataclass
class Attack:
    """`early`: attackers that are there before the service; `words`: those that come when it is
    Ready. Each is the attacker's command line from its mode on. `stop`: which of them are stopped
    (SIGSTOP) as soon as they match, `pipe`: the service's stderr is a pipe that nobody reads,
    `full`: its recording and state are on a file system without room, `clock`: its clock of the
    day jumps, `reuse`: the operator's numbers begin at 1 again before every stop, `at_rest`: it
    begins in Ready, else in a cut, `may_not_serve`: the service may refuse to serve at all."""
    words: tuple = ()
    early: tuple = ()
    stop: bool = False
    pipe: bool = False
    full: bool = False
    clock: bool = False
    reuse: bool = False
    at_rest: bool = False
    may_not_serve: bool = False


def _flood(topics, rate, shape="well", *more):
    return ("flood", "--topics", topics, "--rate", rate, "--shape", shape, *more)


_TOPICS = ("cl_batch cl_session cl_credit command reply jog enabling setpoint drive_command feedback action "
           "action_done status machine latency").split()
_KNOB = _flood("command", 200)
_STICK = ("stick", "--max-samples", 1, "--topics")

ATTACKS = {"none": Attack()}
# Stuck readers, and commands that make the service answer.
for _topic in _TOPICS:
    ATTACKS[f"stuck {_topic}"] = Attack(words=((*_STICK, _topic), _KNOB))
ATTACKS["stuck all"] = Attack(words=((*_STICK, "all"), _KNOB))
ATTACKS["stuck reply, 3000/s"] = Attack(words=((*_STICK, "reply"), _flood("command", 3000)))
ATTACKS["stopped participant"] = Attack(
    words=(("stick", "--lease", 600, "--max-samples", 4, "--topics", "all"), _KNOB), stop=True)
# Floods.
for _topic in _TOPICS:
    ATTACKS[f"flood {_topic} 1000/s"] = Attack(words=(_flood(_topic, 1000),))
    ATTACKS[f"flood {_topic} 10000/s"] = Attack(words=(_flood(_topic, 10000),))
    ATTACKS[f"malformed {_topic} 1000/s"] = Attack(words=(_flood(_topic, 1000, "malformed"),))
    ATTACKS[f"foreign {_topic} 100/s"] = Attack(words=(_flood(_topic, 100, "foreign"),))
    ATTACKS[f"forged {_topic} 200/s"] = Attack(words=(_flood(_topic, 200, "forged"),), at_rest=True)
ATTACKS["takeover"] = Attack(words=(_flood("drive_command,setpoint", 2000, "forged"),),
                             at_rest=True)
ATTACKS["forged command 2000/s"] = Attack(words=(_flood("command", 2000, "forged"),))
ATTACKS["reused id"] = Attack(reuse=True)
# Fakes.
ATTACKS["fake service before"] = Attack(early=(("fake-service",),), may_not_serve=True)
ATTACKS["fake service beside"] = Attack(words=(("fake-service",),), at_rest=True)
ATTACKS["fake service, quoting"] = Attack(words=(("fake-service", "--shape", "forged"),),
                                           at_rest=True)
ATTACKS["fake drives beside"] = Attack(words=(("fake-drives", "--shape", "forged"),), at_rest=True)
# Many.
ATTACKS["60 participants"] = Attack(words=(("crowd", "--count", 60),))
ATTACKS["participants come and go"] = Attack(words=(("churn", "--count", 4, "--rate", 8),))
ATTACKS["sessions"] = Attack(words=(("sessions", "--rate", 600),))
# The host.
ATTACKS["log blocked"] = Attack(words=(_flood("command", 300, "foreign"),), pipe=True)
ATTACKS["disk full"] = Attack(full=True)
ATTACKS["clock steps"] = Attack(clock=True)
# Everything that hurt, at once.
ATTACKS["mixed"] = Attack(words=((*_STICK, "all"), _flood("command", 1000),
                                 _flood("all", 1000, "malformed"),
                                 _flood("reply,cl_credit,status,action_done", 200, "forged"),
                                 ("sessions", "--rate", 100),
                                 ("churn", "--count", 3, "--rate", 3)))


def _limit_files():
    """In the service before it becomes its program: no file beyond 64 KiB, as on a full disk."""
    import resource
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))


def start_plant(plant, attack, seed, shim):
    """Service, drives and operator as the attack wants them."""
    for words in attack.early:
        plant.attack(*words, "--for", 3600, seed=seed)
    if attack.early:
        time.sleep(1.0)
    more = {}
    if attack.pipe:
        plant.unread = os.pipe()  # nobody reads it
        more["stderr"] = plant.unread[1]
        more["stdout"] = plant.unread[1]
    if attack.full:
        more["preexec_fn"] = _limit_files
    if attack.clock:
        more["env"] = dict(os.environ, LD_PRELOAD=str(shim))
    plant.start_service(record=True, **more)
    plant.start_drives()
    plant.start_operator(("--operator-id", 4711) if attack.reuse else ())


def begin(plant, attack, seed):
    for n, words in enumerate(attack.words):
        process = plant.attack(*words, "--for", 3600, seed=seed + n)
        if attack.stop and words[0] == "stick":
            time.sleep(1.0)
            process.send_signal(signal.SIGSTOP)
    time.sleep(1.0 if attack.words else 0.1)
