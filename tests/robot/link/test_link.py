"""The robot's end of the link, against a server that the test plays itself."""

import asyncio
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from benchmarks.body.played_server import AT, PlayedServer, from_server, playing
from protocol.both_ways import Error
from protocol.clock import RealClock
from protocol.envelope import TO_SERVER, parse
from protocol.parts import Battery, Position, Received
from protocol.to_robot import Cancel, EmergencyStop, Pause, Revoke, Welcome
from protocol.to_server import Hello, Why
from robot.link.connection import MAX_UNACKNOWLEDGED, Connection, Ends, Newest, Rhythm
from robot.link.link import MAX_INCOMING, InsecureServer, LinkState, check_secure, retry_delays_s
from robot.mission.memory import Incoming, Memory
from robot.mission.outbox import Outbox
from robot.mission.store import Store
from tests.robot.linked_robot import IMPATIENT, MISSION, QUICK, Robot, a_snapshot, cleared, until


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Robot]:
    with Store(tmp_path / "robot.db") as store:
        yield Robot(store, Outbox(store), Memory(store))


async def test_it_signs_in_with_its_token_and_says_what_it_carries(robot: Robot) -> None:
    robot.memory.load("o7")
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        assert server.tokens == ["Bearer cmr_a_b"]
        hello = server.heard[0].body
        assert isinstance(hello, Hello)
        assert (hello.cargo, hello.received, hello.resume_from) == (("o7",), Received(), 1)
        assert link.problem is None


async def test_a_home_that_the_service_gives_is_kept_and_passed_on_once(robot: Robot) -> None:
    async with playing() as server:
        server.home = "post4_bay2"
        async with robot.linked(server.url) as link:
            await until(lambda: link.online)
            assert robot.memory.home() == "post4_bay2"
            assert [type(one.message).__name__ for one in link.incoming()] == ["Welcome"], "what is held has changed"
            server.sockets[-1].transport.abort()
            await until(lambda: server.types().count("hello") == 2)
            assert list(link.incoming()) == []


async def test_the_snapshot_overtakes_the_backlog_which_is_flagged_and_in_order(robot: Robot) -> None:
    for post in ("post2", "post3", "post4"):
        robot.outbox.put(cleared(post))
    async with playing() as server:
        server.received = Received(journal=robot.outbox.journal, seq=1)
        async with robot.linked(server.url) as link:
            link.snapshot(a_snapshot("post3"))
            await until(lambda: 3 in server.numbers())
            robot.outbox.put(cleared("post5"))
            link.wake()
            await until(lambda: 4 in server.numbers())
    assert server.types() == ["hello", "snapshot", "clear", "clear", "clear"]
    assert server.numbers() == [2, 3, 4]
    assert [envelope.replay for envelope in server.heard if envelope.seq] == [True, True, False]
    assert [kept.seq for kept in robot.outbox.pending()] == [2, 3, 4], "what the welcome acknowledged is forgotten"


async def test_what_is_not_acknowledged_is_sent_again_after_a_cut_and_what_is_not(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        first, second = robot.outbox.put(cleared("post2")), robot.outbox.put(cleared("post3"))
        link.wake()
        await until(lambda: server.numbers() == [first, second])
        await server.send(Error(code="note", message="just an acknowledgement"), ack=first)
        await until(lambda: robot.outbox.waiting() == 1)
        server.received = Received(journal=robot.outbox.journal, seq=first)
        server.sockets[-1].transport.abort()
        await until(lambda: server.numbers() == [first, second, second])
        assert server.heard[-1].replay


async def test_a_message_is_acknowledged_when_it_is_stored_and_waits_until_it_was_handled(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(MISSION, seq=1)
        await until(lambda: server.heard[-1].ack == 1)
        assert robot.memory.mission() == MISSION
        assert [incoming.message for incoming in link.incoming()] == [MISSION]
        assert link.incoming() == []
    async with playing() as server, robot.linked(server.url) as link:
        (again,) = link.incoming()
        assert again.message == MISSION, "it was not handled before the restart"
        robot.memory.handled(again)
    assert robot.memory.unhandled() == []


async def test_a_repeated_message_is_acknowledged_and_not_delivered_again(robot: Robot) -> None:
    cancel = Cancel(command_id="c1", order_id="o1")
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        for seq in (1, 2, 2, 1, 2, 3):
            await server.send(cancel if seq < 3 else Pause(command_id="c2", reason="x"), seq=seq)
        await until(lambda: server.heard[-1].ack == 3)
        assert [incoming.seq for incoming in link.incoming()] == [1, 2, 3]
        assert [envelope.ack for envelope in server.heard if envelope.type == "ack"] == [1, 2, 2, 2, 2, 3]


async def test_a_gap_is_not_taken_and_makes_the_robot_resume(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(MISSION, seq=2)
        await until(lambda: server.types().count("hello") == 2)
        hello = server.heard[-1].body
        assert isinstance(hello, Hello)
        assert hello.received == Received(journal="server-journal", seq=0)
        assert robot.memory.mission() is None


async def test_messages_that_can_never_come_are_skipped_instead_of_waited_for(robot: Robot) -> None:
    async with playing(server=PlayedServer(resume_from=41)) as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(MISSION, seq=41)
        await until(lambda: server.heard[-1].ack == 41)


async def test_a_robot_whose_disk_was_put_back_begins_a_new_journal(robot: Robot) -> None:
    robot.outbox.put(cleared())
    old = robot.outbox.journal
    async with playing() as server:
        server.received = Received(journal=old, seq=17)
        async with robot.linked(server.url):
            await until(lambda: server.numbers() == [1])
    assert server.heard[-1].journal == robot.outbox.journal != old
    assert server.heard[-1].body == cleared()


async def test_other_stops_under_the_same_number_are_refused_by_name_and_the_first_are_kept(robot: Robot) -> None:
    other = MISSION.model_copy(update={"stops": ()})
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(MISSION, seq=1)
        await server.send(other, seq=2)
        await until(lambda: server.types()[-1] == "error")
        error = server.heard[-1].body
        assert isinstance(error, Error)
        assert (error.code, error.seq, server.heard[-1].ack) == ("mission_conflict", 2, 2)
        assert robot.memory.mission() == MISSION
        assert len(link.incoming()) == 1


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("no json", "malformed_message"),
        ('{"v":1,"type":"dance","robot":"r1","journal":"j","at":"2026-01-05T09:00:00Z","body":{}}', "unknown_message"),
        ('{"v":2,"type":"mission"}', "newer_version"),
    ],
)
async def test_what_it_cannot_read_is_answered_by_name_and_the_connection_begins_anew(
    robot: Robot, text: str, code: str
) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.sockets[0].send(text)
        await until(lambda: server.types().count("hello") == 2)
        error = next(envelope.body for envelope in server.heard if envelope.type == "error")
        assert isinstance(error, Error)
        assert error.code == code
        assert server.sockets[0].close_code == 4400


async def test_an_error_from_the_server_reaches_the_daemon(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(Error(code="unknown_order", message="there is no order o9", seq=3))
        arrived: list[Incoming] = []

        def something_arrived() -> bool:
            arrived.extend(link.incoming())
            return bool(arrived)

        await until(something_arrived)
        assert [one.message for one in arrived] == [Error(code="unknown_order", message="there is no order o9", seq=3)]


async def test_a_network_that_swallows_everything_is_noticed_and_left_behind(robot: Robot) -> None:
    async def black_hole(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        far_reader, far_writer = await asyncio.open_connection("127.0.0.1", int(server.url.rsplit(":", 1)[1]))
        ways.append(asyncio.create_task(copy(reader, far_writer)))
        ways.append(asyncio.create_task(copy(far_reader, writer)))

    async def copy(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        while data := await reader.read(4096):
            await open_way.wait()
            writer.write(data)
        writer.close()

    ways: list[asyncio.Task[None]] = []
    open_way = asyncio.Event()
    open_way.set()
    async with playing() as server, await asyncio.start_server(black_hole, "127.0.0.1", 0) as wire:
        async with robot.linked(f"ws://127.0.0.1:{wire.sockets[0].getsockname()[1]}", IMPATIENT) as link:
            await until(lambda: link.online)
            open_way.clear()
            await until(lambda: not link.online)
            assert link.problem
            open_way.set()
            await until(lambda: link.online)
        for way in ways:
            way.cancel()


async def test_it_comes_back_when_the_server_was_away(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        port = int(server.url.rsplit(":", 1)[1])
        server.sockets[0].transport.abort()
        async with robot.linked("ws://127.0.0.1:1") as hopeless:
            await until(lambda: hopeless.problem)
            assert (hopeless.state, hopeless.online) == (LinkState.OFFLINE, False)
        await until(lambda: len(server.sockets) == 2)
    robot.outbox.put(cleared())
    async with robot.linked(f"ws://127.0.0.1:{port}") as link:
        await until(lambda: link.problem)
        async with playing(port) as server:
            await until(lambda: server.numbers() == [1])


@pytest.mark.parametrize(("code", "state"), [(4401, LinkState.REFUSED), (4409, LinkState.REPLACED)])
async def test_a_refused_token_or_a_newer_connection_ends_the_link_with_a_reason(
    robot: Robot, code: int, state: LinkState
) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.sockets[0].close(code)
        await until(lambda: link.state is state)
        assert link.problem
        await asyncio.sleep(0.3)
        assert len(server.sockets) == 1, "it does not come back"


async def test_snapshots_are_dropped_and_events_are_not(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        began_s = time.monotonic()
        for number in range(40):
            link.snapshot(a_snapshot(f"post{number}"))
            robot.outbox.put(cleared(f"post{number}"))
            link.wake()
            await asyncio.sleep(0.01)
        await until(lambda: len(server.numbers()) == 40)
        await until(lambda: server.heard[-1].body == a_snapshot("post39"))
        most = 2 + (time.monotonic() - began_s) / QUICK.snapshot_every_s
        assert 2 <= server.types().count("snapshot") <= min(most, 20)


async def test_a_slow_server_gets_no_more_than_it_acknowledges(robot: Robot) -> None:
    for _ in range(MAX_UNACKNOWLEDGED + 10):
        robot.outbox.put(cleared())
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: len(server.numbers()) == MAX_UNACKNOWLEDGED)
        await asyncio.sleep(0.1)
        assert len(server.numbers()) == MAX_UNACKNOWLEDGED
        await server.send(Error(code="note", message=""), ack=MAX_UNACKNOWLEDGED)
        await until(lambda: len(server.numbers()) == MAX_UNACKNOWLEDGED + 10)
        assert link.online


async def test_a_daemon_that_takes_nothing_is_not_buried_and_misses_nothing(robot: Robot) -> None:
    many = MAX_INCOMING + 20
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        for seq in range(1, many + 1):
            await server.send(Pause(command_id=f"p{seq}", reason=""), seq=seq)
        await until(lambda: server.heard[-1].ack == MAX_INCOMING)
        await asyncio.sleep(0.2)
        assert server.heard[-1].ack == MAX_INCOMING, "what cannot be taken is not acknowledged"
        taken = link.incoming()
        await until(lambda: server.heard[-1].ack == many)
        taken += link.incoming()
        assert [incoming.seq for incoming in taken] == list(range(1, many + 1))


async def test_an_emergency_stop_stops_the_robot_though_its_mind_takes_no_messages(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        await until(lambda: link.online)
        await server.send(EmergencyStop(command_id="s1", reason="a child plays there"), seq=1)
        await until(lambda: server.heard[-1].ack == 1)
        await server.send(Revoke(command_id="s2", reason="carried away"), seq=2)
        await until(lambda: server.heard[-1].ack == 2)
        assert len(robot.stops) == 2, "nor does one whose corridors are given to others drive on"
        assert [one.message.command_id for one in link.incoming()] == ["s1", "s2"], "it is answered as any command is"


@dataclass
class BreakingSocket:
    """Says what it was given to say, and breaks when an acknowledgement is to be sent."""

    texts: list[str]

    async def send(self, message: str) -> None:
        if parse(message, TO_SERVER).type == "ack":
            raise ConnectionResetError

    async def recv(self) -> str:
        return self.texts.pop(0)

    async def close(self, code: int = 1000, reason: str = "") -> None:
        pass


async def test_what_was_stored_is_delivered_even_if_it_cannot_be_acknowledged(robot: Robot) -> None:
    """The server need not send it again, so it would not be delivered before the next start."""
    delivered: list[Incoming] = []
    hello = Hello(position=Position(), battery=Battery(ratio=0.8), software="0.1.0", map_version="m1")
    ends = Ends("r1", RealClock(), robot.outbox, robot.memory, lambda: hello, Newest(), delivered.append, QUICK)
    welcome = Welcome(received=Received(), server="played", at=AT)
    room = asyncio.Event()
    room.set()
    socket = BreakingSocket([from_server(welcome).to_text(), from_server(MISSION, 1).to_text()])
    connection = Connection(socket, ends, asyncio.Event(), room)
    await connection.greet()
    with pytest.raises(ConnectionResetError):
        await connection.run()
    assert [incoming.message for incoming in delivered] == [MISSION]
    assert robot.memory.received().seq == 1


async def test_the_reason_is_said_when_it_changes_and_again_after_a_reconnect(robot: Robot) -> None:
    async with playing() as server, robot.linked(server.url) as link:
        for sentence in ("waits for the sender", "waits for the sender", "drives to post4"):
            link.say(Why(sentence=sentence))
            await until(lambda: link.online and "why" in server.types())
            await asyncio.sleep(0.02)
        await until(lambda: server.types().count("why") == 2)
        server.sockets[0].transport.abort()
        await until(lambda: server.types().count("why") == 3)


def test_unencrypted_links_are_for_this_machine_only() -> None:
    for url in ("wss://mail.example/link", "ws://127.0.0.1:8000/x", "ws://localhost:1/", "ws://[::1]:8000/"):
        check_secure(url)
    for url in ("ws://mail.example/link", "http://127.0.0.1", "ws://10.0.0.1/", "ws://127.0.0.1.evil.example/"):
        with pytest.raises(InsecureServer, match="use wss"):
            check_secure(url)


def test_tries_are_quick_at_first_and_never_rarer_than_the_limit() -> None:
    delays_s = retry_delays_s(Rhythm())
    first, *others = [next(delays_s) for _ in range(12)]
    assert first <= 0.2
    assert all(delay_s <= 15.0 for delay_s in others)
    assert others[-1] >= 7.5
