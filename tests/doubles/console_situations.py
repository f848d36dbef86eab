"""Situations that the console is looked at in: each plays a run, and opens its view."""

import json
from collections.abc import Awaitable, Callable, Sequence
from contextlib import suppress
from typing import Literal
from uuid import UUID

from console_in_browser import TOKEN, OpenPage
from gated_robot import gated_robot
from office_with_fleet import open_office_with_fleet
from playwright.async_api import Page, expect
from recorded_service import recorded_events
from small_model import packed
from two_boxes import BENCH, BLUE, BOTH, RED

from mend.fleet.requests import DeliverMessage, GoToRoom, Transport
from mend.maps.building.building import Building
from mend.maps.building.random_building import random_building
from mend.server.client import MendClient
from mend.server.composition import Service
from mend.server.fleets.operator_requests import WayReport
from mend.server.fleets.request_refused import RequestRefusedError
from mend.server.journal.journal import Entry
from mend.server.runtime.requests import RunRequest
from mend.server.runtime.steering_views import SteerNode
from mend.server.runtime.views import RunStatus
from mend.server.sites.requests import SiteRequest
from mend.sim.building.scene import scene_of
from mend.tasks.autonomy import AutonomyLevel
from mend.tasks.intervention import Intervention
from mend.tasks.scenario import Person

STEAL = Intervention.model_validate({"act": "steal", "object": "green_leg"})
PATIENCE_MS = 60_000
MOST_TRIES = 20


async def ask(service: Service, world: str = "tabletop") -> UUID:
    """Start a run whose first part is stolen, so that its robot asks live helpers."""
    request = RunRequest(tree="eket", world=world, speed=5.0, person=Person(acts=False))
    run = await service.runtime.start_run(request)
    await service.runtime.intervene(run.id, STEAL)
    return run.id


async def no_question(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/")
    await expect(page.get_by_text("No robot asks")).to_be_visible()
    return page


async def open_question(service: Service, open_page: OpenPage) -> Page:
    page = await open_page("/")
    await ask(service)
    await expect(page.get_by_role("button", name="YES")).to_be_visible(timeout=PATIENCE_MS)
    return page


async def question_queue(service: Service, open_page: OpenPage) -> Page:
    """Two robots ask the same, and both stand in one entry that is open."""
    page = await open_page("/")
    await ask(service)
    await ask(service)
    batch = page.locator(".queue-batch summary")
    await expect(batch).to_be_visible(timeout=PATIENCE_MS)
    if await page.locator(".queue-batch[open]").count() == 0:
        await batch.click()
    await expect(page.get_by_role("button", name="Not now, all 2")).to_be_visible()
    return page


async def told_ending(service: Service, open_page: OpenPage) -> Page:
    """A question is gone because its run is, and the next one has its place."""
    page = await open_page("/")
    first = await ask(service)
    await expect(page.get_by_role("button", name="YES")).to_be_visible(timeout=PATIENCE_MS)
    await ask(service)
    await expect(page.get_by_role("heading", name="2 questions")).to_be_visible(timeout=PATIENCE_MS)
    await service.runtime.abort(first)
    await expect(page.get_by_text("the robot has stopped this task")).to_be_visible()
    return page


async def waiting_for_help(service: Service, open_page: OpenPage) -> Page:
    page = await open_question(service, open_page)
    await page.get_by_role("button", name="YES").click()
    await expect(page.get_by_role("button", name="Done, look again")).to_be_visible(
        timeout=PATIENCE_MS
    )
    return page


async def no_runs(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/runs")
    await expect(page.get_by_text("No runs yet")).to_be_visible()
    return page


async def runs(service: Service, open_page: OpenPage) -> Page:
    await ask(service)
    await keep_recorded(service)
    page = await open_page("/runs")
    await expect(page.get_by_text("The task is done")).to_be_visible()
    await expect(page.get_by_text("Asks a question")).to_be_visible(timeout=PATIENCE_MS)
    return page


async def issues(service: Service, open_page: OpenPage) -> Page:
    await keep_recorded(service)
    page = await open_page("/issues")
    await expect(page.get_by_text("unreachable")).to_be_visible()
    return page


async def statistics(service: Service, open_page: OpenPage) -> Page:
    await keep_recorded(service)
    page = await open_page("/statistics")
    await expect(page.get_by_role("region", name="By part")).to_be_visible()
    return page


async def live_run(service: Service, open_page: OpenPage) -> Page:
    run = await ask(service)
    page = await open_page(f"/runs/{run}")
    await expect(page.get_by_role("link", name="Questions 1")).to_be_visible(timeout=PATIENCE_MS)
    await expect(page.get_by_role("main").get_by_text("Loading …")).to_have_count(0)
    # What it was like is looked at; the robot need not go on meanwhile.
    await service.runtime.pause(run)
    await expect(page.get_by_role("button", name="Resume")).to_be_visible()
    return page


async def begin_two_boxes(service: Service, speed: float | Literal["max"] = 1.0) -> UUID:
    """Start a run whose robot is at one box for a while, so that a person can take the other."""
    await service.library.scenes.save("small_bench", BENCH)
    await service.library.trees.save("both", BOTH)
    request = RunRequest(tree="both", world="tabletop", speed=speed, seed=2)
    return (await service.runtime.start_run(request)).id


ROUNDS = ("F1-104", "F2-204", "F1-101", "F2-201")


IN_THE_WAY = {
    "name": "in_the_way",
    "tree": "rounds",
    # While the first robot leaves its room: there is no way round then.
    "interventions": [{"at_s": 3.0, "do": {"act": "block"}}],
}


async def keep_office(service: Service, drawn: int = 8, places: Sequence[str] = ROUNDS) -> None:
    """Have an office with two floors and a robot on each, and a task there."""
    going = [{"behavior": "go_to", "place": each, "name": f"round_{each}"} for each in places]
    rounds = {"name": "rounds", "scene": "office", "tree": {"and": going}}
    scene = scene_of(Building(random_building(drawn, 2, 6)), "office", 2)
    await service.library.scenes.save("office", scene.model_dump_json(exclude_defaults=True))
    await service.library.trees.save("rounds", json.dumps(rounds))
    await service.library.scenarios.save("in_the_way", json.dumps(IN_THE_WAY))


async def begin_rounds(
    service: Service,
    speed: float | Literal["max"] = 1.0,
    shut_doors: float = 0.0,
    scenario: str | None = None,
    drawn: int = 8,
    places: Sequence[str] = ROUNDS,
) -> UUID:
    """Start a run of two robots in an office, one on each of its floors."""
    await keep_office(service, drawn, places)
    request = RunRequest(
        tree="rounds",
        world="building",
        speed=speed,
        seed=2,
        scenario=scenario,
        answers="live",
        person=Person(acts=False),
        world_options={"shut_doors": shut_doors, "localizer": "exact", "unmapped": 0.0},
    )
    return (await service.runtime.start_run(request)).id


async def run_in_building(service: Service, open_page: OpenPage) -> Page:
    """Both robots stand before shut doors, and the first that did asks."""
    run = await begin_rounds(service, speed=5.0, shut_doors=1.0)
    page = await open_page(f"/runs/{run}")
    await expect(page.get_by_role("link", name="Questions 2")).to_be_visible(timeout=PATIENCE_MS)
    await expect(page.get_by_role("main").get_by_text("Loading …")).to_have_count(0)
    building = page.get_by_role("tab", name="Building")
    if await building.count() > 0:
        await building.click()
    robots = page.get_by_role("list", name="Robots")
    await expect(robots.get_by_text("Asking").first).to_be_visible(timeout=PATIENCE_MS)
    await service.runtime.pause(run)
    return page


async def taken_leaf(service: Service, open_page: OpenPage) -> Page:
    """A person does one of the boxes, and has been told that the other is the robot's."""
    page = await open_page(f"/runs/{await begin_two_boxes(service)}")
    red_box = page.get_by_role("treeitem", name="red box")
    await expect(red_box).to_have_attribute("data-state", "active", timeout=PATIENCE_MS)
    words = page.get_by_label("Choose a leaf that waits, or say it")
    for said in ("I do the blue box", "I do the red box"):
        await words.fill(said)
        await page.get_by_role("button", name="Say it").click()
    await expect(page.get_by_text("'red_box' cannot be taken now")).to_be_visible()
    await expect(page.get_by_text("You are doing blue box")).to_be_visible()
    return page


async def begin_steered(service: Service) -> UUID:
    """Start a run of two boxes whose robot begins nothing by itself."""
    await service.library.scenes.save("small_bench", BENCH)
    await service.library.trees.save("both", BOTH)
    request = RunRequest(
        tree="both", world="tabletop", speed="max", seed=2, autonomy=AutonomyLevel.OFF
    )
    return (await service.runtime.start_run(request)).id


async def steered_run(service: Service, open_page: OpenPage) -> Page:
    """A robot waits at a breakpoint, and what may be said of that node is open."""
    run = await begin_steered(service)
    for act, node in (("set_breakpoint", BLUE), ("go_on", RED)):
        said = {"act": act, "node": node, "reason": "the glue is still wet"}
        await service.runtime.steer(run, SteerNode.model_validate(said), "bert")
    page = await open_page(f"/runs/{run}")
    await expect(page.get_by_role("button", name="Go on: blue box")).to_be_visible(
        timeout=PATIENCE_MS
    )
    await page.get_by_role("treeitem", name="blue box").click()
    await page.get_by_text("What cannot be said now").click()
    return page


STOLEN = {
    "name": "stolen",
    "tree": "both",
    "interventions": [{"at_s": 0.0, "do": {"act": "steal", "object": "red_box"}}],
    "answers": ["yes"],
    "answer_delay_s": 1.0,
    "person": {"delay_s": 1.0},
}


async def keep_recorded(service: Service) -> UUID:
    """Have a run of the paper's scenario that has ended, once; its id."""
    events = recorded_events()
    if not await service.runtime.has_run(events[0].run):
        await service.journal.append(Entry(events=events))
    return events[0].run


async def past_of_run(service: Service, open_page: OpenPage) -> Page:
    page = await open_page(f"/runs/{await keep_recorded(service)}")
    await page.get_by_role("button", name="Previous fault").click()
    await expect(page.get_by_role("button", name="Copy link")).to_be_visible()
    return page


async def plotted_run(service: Service, open_page: OpenPage) -> Page:
    page = await finished_run(service, open_page)
    if await page.get_by_role("tab", name="Timeline").is_visible():
        await page.get_by_role("tab", name="Timeline").click()
    await page.get_by_role("button", name="Plots", exact=True).click()
    for number in ("node started: attempt", "gripper: opening"):
        await page.get_by_label("Number to plot").select_option(label=number)
        await expect(page.get_by_role("slider", name=number)).to_be_visible()
    attempts = page.get_by_role("region", name="node started: attempt")
    await attempts.get_by_role("button", name="As a table").click()
    return page


async def finished_run(service: Service, open_page: OpenPage) -> Page:
    """A box was stolen, which was talked over, and put back."""
    await service.library.scenes.save("small_bench", BENCH)
    await service.library.trees.save("both", BOTH)
    await service.library.scenarios.save("stolen", json.dumps(STOLEN))
    return await _at_its_end(
        service,
        open_page,
        RunRequest(tree="both", world="tabletop", speed="max", scenario="stolen", seed=2),
    )


async def finished_run_of_the_paper(service: Service, open_page: OpenPage) -> Page:
    """All of its faults were talked over, which takes longer to simulate."""
    request = RunRequest(tree="eket", world="tabletop", speed="max", scenario="eket_paper")
    return await _at_its_end(service, open_page, request)


async def _at_its_end(service: Service, open_page: OpenPage, request: RunRequest) -> Page:
    run = await service.runtime.start_run(request)
    view = await service.runtime.wait_for_end(run.id)
    assert view.status is RunStatus.FINISHED
    page = await open_page(f"/runs/{run.id}")
    main = page.get_by_role("main")
    await expect(main.get_by_role("heading", level=1)).to_be_visible(timeout=PATIENCE_MS)
    await expect(main.get_by_text("Loading …")).to_have_count(0, timeout=PATIENCE_MS)
    return page


async def trees(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/trees")
    await expect(page.get_by_role("tree")).to_be_visible()
    return page


async def wrong_tree(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/edit/eket")
    text = page.get_by_label("The file of the task tree")
    await text.fill((await text.input_value()).replace("object: pink_bar", "object: pink_ber"))
    await expect(page.get_by_role("button", name="Line 9")).to_be_visible()
    return page


async def scenes(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/scenes")
    await expect(page.get_by_role("link", name="Copy and edit eket")).to_be_visible()
    return page


async def scene_out_of_reach(
    service: Service, open_page: OpenPage, scene: str = "small_bench"
) -> Page:
    """A box was moved where no robot reaches it."""
    await service.library.scenes.save("small_bench", BENCH)
    page = await open_page(f"/edit_scene/{scene}")
    await page.get_by_label("Forward x (m)").fill("0.95")
    await page.get_by_label("Forward x (m)").press("Enter")
    mistake = page.locator(".mistake-line").filter(has_text="does not reach (0.950")
    await expect(mistake.first).to_be_visible(timeout=PATIENCE_MS)
    await page.evaluate("scrollTo(0, 0)")
    return page


async def part_to_be_added(_: Service, open_page: OpenPage) -> Page:
    """A part is selected, with what it is turned and resized by, and another one is described."""
    page = await open_page("/edit_scene")
    box = page.get_by_role("button", name="red box, part")
    await box.focus()
    await page.keyboard.press("n")
    await expect(page.get_by_role("form", name="A new part")).to_be_visible()
    await expect(page.get_by_role("status").filter(has_text="No mistakes")).to_be_visible()
    return page


async def robot_models(service: Service, open_page: OpenPage) -> Page:
    """One of two robots has a model, and a file is about to be given for the other."""
    await give_model(service, "lamp", packed())
    shown = [{"model": name, "joints": ["elbow"], "objects": []} for name in ("lamp", "crane")]
    async with (
        gated_robot(service.robots_url, TOKEN, "arm-1", shows=shown[0]),
        gated_robot(service.robots_url, TOKEN, "arm-2", shows=shown[1]),
    ):
        page = await open_page("/models")
        await expect(page.get_by_text("Named by arm-2; a gripper")).to_be_visible()
        file = {"name": "lamp.zip", "mimeType": "application/zip", "buffer": packed()}
        await page.get_by_label("Give a model").set_input_files(file)
        await expect(page.get_by_label("Name, as robots say it")).to_have_value("crane")
    return page


async def give_model(service: Service, name: str, archive: bytes) -> None:
    """Have a model there, as an operator gives it."""
    async with MendClient(service.url, token=TOKEN) as client:
        await client.put_model(name, archive)


async def delete_tree(service: Service, open_page: OpenPage) -> Page:
    await service.library.trees.save(
        "shelf", "name: shelf\ntree: {behavior: pick_and_place, object: a, place: b}\n"
    )
    page = await open_page("/trees/shelf")
    await page.get_by_role("button", name="Delete").click()
    await expect(page.get_by_role("dialog")).to_be_visible()
    return page


async def start_run(service: Service, open_page: OpenPage) -> Page:
    await service.sites.open_site(SiteRequest(scene="kit", world="tabletop"))
    page = await open_page("/start/eket")
    await page.get_by_role("spinbutton", name="Seed").fill("-1")
    await page.get_by_role("button", name="Start the run").click()
    await expect(page.get_by_role("alert").filter(has_text="greater than or equal")).to_be_visible()
    return page


async def settings(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/settings")
    await expect(page.get_by_role("heading", name="Settings")).to_be_visible()
    return page


async def question_in_german(service: Service, open_page: OpenPage) -> Page:
    page = await open_question(service, open_page)
    await read_in_german(page)
    await expect(page.get_by_role("button", name="JA")).to_be_visible()
    return page


async def run_in_german(service: Service, open_page: OpenPage) -> Page:
    page = await finished_run(service, open_page)
    await read_in_german(page)
    await expect(page.get_by_role("heading", name="Baum")).to_be_visible()
    return page


async def read_in_german(page: Page) -> None:
    """Have a page once more, in German."""
    await page.evaluate("""() => localStorage.setItem("mend.language", '"de"')""")
    await page.reload()
    await expect(page.locator("html")).to_have_attribute("lang", "de")


async def unknown(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/runs")
    await page.evaluate(
        "history.replaceState(null, '', '/nowhere'); dispatchEvent(new Event('popstate'))"
    )
    await expect(page.get_by_role("heading", name="There is nothing")).to_be_visible()
    return page


async def requests(service: Service, open_page: OpenPage) -> Page:
    """One is under way, one waits for its time, and one was refused."""
    site = await open_office_with_fleet(service)
    wanted = [
        Transport(name="parcel", what="the blue parcel", origin="F1/101", destination="F1/106"),
        DeliverMessage(name="lunch", place="F1/103", message="Lunch.", earliest_s=600.0),
    ]
    for each in wanted:
        await service.fleets.submit(site, each, None)
    with suppress(RequestRefusedError):
        soon = GoToRoom(name="soon", place="F1/106", latest_s=1.0)
        await service.fleets.submit(site, soon, None)
    page = await open_page("/requests")
    under_way = page.get_by_role("list", name="Open requests").get_by_text("Under way")
    await expect(under_way).to_be_visible(timeout=PATIENCE_MS)
    await expect(page.get_by_text("Refused")).to_be_visible()
    return page


async def fleet(service: Service, open_page: OpenPage) -> Page:
    """One robot is under way, one out of service, and a way is closed."""
    site = await open_office_with_fleet(service, robots=2, floors=2)
    at_work = await service.fleets.fleet(site)
    _, second = at_work.dispatcher.fleet.robots
    await at_work.operators.take_out(second, "its wheel squeaks", None)
    lane = at_work.dispatcher.building.floors["F1"].lanes[0]
    between = [f"F1/{each}" for each in lane.between]
    await at_work.operators.found(WayReport(finding="blocked", between=between), None)
    wanted = [
        Transport(name="parcel", what="the blue parcel", origin="F1/101", destination="F1/106"),
        DeliverMessage(name="lunch", place="F1/103", message="Lunch.", earliest_s=600.0),
    ]
    for each in wanted:
        await service.fleets.submit(site, each, None)
    page = await open_page("/fleet")
    robots = page.get_by_role("list", name="Robots of the fleet")
    await expect(robots.get_by_text("collects parcel at")).to_be_visible(timeout=PATIENCE_MS)
    await expect(robots.get_by_text("Out of service", exact=False).first).to_be_visible()
    await expect(page.get_by_role("list", name="Ways that are closed now")).to_be_visible()
    await expect(page.locator(".plan-robot").first).to_be_visible(timeout=PATIENCE_MS)
    return page


async def sign_in(_: Service, open_page: OpenPage) -> Page:
    page = await open_page("/")
    await page.context.clear_cookies()
    await page.reload()
    await page.get_by_label("Token").fill("wrong")
    await page.get_by_role("button", name="Sign in").click()
    await expect(page.get_by_role("alert")).to_have_text("This is not the token.")
    return page


Situation = Callable[[Service, OpenPage], Awaitable[Page]]


async def touch_screen(service: Service, open_page: OpenPage) -> Page:
    """The start of a robot's touch screen, after words that it has not understood."""
    site = await open_office_with_fleet(service, floors=8)
    robot = next(iter((await service.fleets.fleet(site)).dispatcher.fleet.robots))
    page = await open_page(f"/robots/{robot}/ask")
    await page.get_by_label("Say it in words").fill("go to the moon", timeout=PATIENCE_MS)
    await page.get_by_role("button", name="Say it").click()
    await expect(page.get_by_role("alert").filter(has_text="the moon")).to_be_visible()
    return page


async def touch_place(service: Service, open_page: OpenPage) -> Page:
    """A room is being chosen there."""
    page = await touch_screen(service, open_page)
    await page.get_by_role("button", name="Come to a room").click()
    await page.get_by_role("button", name="F2", exact=True).click()
    await page.get_by_role("button", name="2", exact=True).click()
    return page


async def touch_refused(service: Service, open_page: OpenPage) -> Page:
    """Something is wanted there too soon, and offered for later."""
    page = await touch_screen(service, open_page)
    await page.get_by_label("Say it in words").fill("come to F8 806 within 1 minute")
    await page.get_by_role("button", name="Say it").click()
    await page.get_by_role("button", name="Yes, that is right").click()
    await expect(page.get_by_role("button", name="instead")).to_be_visible(timeout=PATIENCE_MS)
    return page


async def touch_unanswered(service: Service, open_page: OpenPage) -> Page:
    """Something is wanted there, and no answer comes to that."""
    page = await touch_screen(service, open_page)
    await page.get_by_label("Say it in words").fill("come to F8 806")
    await page.get_by_role("button", name="Say it").click()
    await page.clock.install()
    await page.route(
        "**/api/requests?*",
        lambda route: route.abort() if route.request.method == "POST" else route.continue_(),
    )
    await page.get_by_role("button", name="Yes, that is right").click()
    unknown = page.get_by_text("I do not know whether that was booked.")
    for _ in range(MOST_TRIES):
        await expect(page.get_by_text("I try once more").or_(unknown)).to_be_visible()
        if await unknown.is_visible():
            break
        await page.clock.run_for(5_000)
    await expect(unknown).to_be_visible()
    return page


async def waited_for(service: Service, open_page: OpenPage) -> Page:
    """Something was asked for at a touch screen, whose robot waits for somebody to put it in."""
    site = await open_office_with_fleet(service, 20.0, answers="live")
    robot = next(iter((await service.fleets.fleet(site)).dispatcher.fleet.robots))
    page = await open_page(f"/robots/{robot}/ask")
    words = page.get_by_label("Say it in words")
    await words.fill("bring the tea from 103 to 106", timeout=PATIENCE_MS)
    await page.get_by_role("button", name="Say it").click()
    await page.get_by_role("button", name="Yes, that is right").click()
    mine = page.get_by_role("region", name="Your request")
    await expect(mine).to_contain_text("I wait for somebody to help me", timeout=PATIENCE_MS)
    return page


async def booked_request(service: Service, open_page: OpenPage) -> Page:
    """Something was asked for on the booking page, and is followed."""
    await open_office_with_fleet(service)
    page = await open_page("/requests")
    await page.get_by_label("Have a robot come").check(timeout=PATIENCE_MS)
    await page.get_by_label("Where").fill("106")
    await page.get_by_role("button", name="Ask for it").click()
    await expect(page.get_by_role("region", name="Your request")).to_be_visible()
    return page


async def recorded_cameras(service: Service, open_page: OpenPage) -> Page:
    """Somebody has the cameras recorded."""
    run = await ask(service)
    page = await open_page(f"/runs/{run}")
    await expect(page.get_by_role("link", name="Questions 1")).to_be_visible(timeout=PATIENCE_MS)
    scene = page.get_by_role("tab", name="Scene")
    cameras = page.get_by_role("region", name="Cameras")
    await expect(scene.or_(cameras)).to_be_visible()
    if await scene.count() > 0:
        await scene.click()
    await cameras.get_by_role("button", name="Record").click()
    await expect(cameras.get_by_role("button", name="Recording …")).to_be_visible()
    # Pressing it has scrolled a small window, to where a row may stick out from under a bar.
    await page.evaluate(
        "for (const each of document.querySelectorAll('*')) if (each.scrollTop) each.scrollTop = 0"
    )
    return page


SITUATIONS: dict[str, Situation] = {
    each.__name__: each
    for each in (
        no_question,
        open_question,
        question_queue,
        told_ending,
        waiting_for_help,
        no_runs,
        runs,
        issues,
        statistics,
        live_run,
        recorded_cameras,
        run_in_building,
        taken_leaf,
        steered_run,
        finished_run,
        past_of_run,
        plotted_run,
        trees,
        wrong_tree,
        scenes,
        scene_out_of_reach,
        part_to_be_added,
        robot_models,
        delete_tree,
        start_run,
        requests,
        booked_request,
        touch_screen,
        touch_place,
        touch_refused,
        touch_unanswered,
        waited_for,
        fleet,
        settings,
        question_in_german,
        run_in_german,
        unknown,
        sign_in,
    )
}
