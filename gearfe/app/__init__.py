"""Live page, `gearfe app`: fields, a scene of them, solver processes that compute it, a server that shows it.

The state of the page is a scene: `fields` names its keys, `state` writes and reads it, `solving` computes it in the processes of
`workers`, `server` answers a browser on this machine, and `guard` decides whom. Only `server` imports starlette and uvicorn.
"""
