"""Two tasks of one asyncio program: one moves the machine, the other does something else."""

import asyncio

from hexarm import Robot


async def move(robot):
    for height in (0.047, 0.043, 0.045):
        robot.move(z=height, wait=False, progress=lambda share: print(f'{share:.0%}'))
        await robot.done()


async def work(robot):
    mover = asyncio.create_task(move(robot))
    while not mover.done():
        await asyncio.sleep(0.05)  # here a camera is read, a page is served, …
    await mover


with Robot('/hexapod') as robot:
    robot.enable()
    asyncio.run(work(robot))
