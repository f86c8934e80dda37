"""Live page of `gearfe app`: input fields, the scene that they define, solver processes and a server.

The state of the page is a scene: `fields` names its keys, `state` writes and reads it, `solving` computes it in the processes of
`workers`, `server` answers a browser on this machine, and `guard` decides which requests are accepted. Only `server` imports
starlette and uvicorn.
"""
