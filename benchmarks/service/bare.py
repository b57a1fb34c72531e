"""The baseline for the service: one endpoint, one durable insert, nothing else.

The same framework, server, driver and database settings (write-ahead log, full sync), used as their manuals say.
`python -m benchmarks.service.bare DATABASE PORT`
"""

import sys
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from datetime import UTC, datetime
from typing import Any
from uuid import uuid4

import uvicorn
from fastapi import FastAPI
from pydantic import BaseModel
from sqlalchemy import DateTime, MetaData, String, event
from sqlalchemy.ext.asyncio import AsyncSession, create_async_engine
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column

PRAGMAS = ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON", "busy_timeout=10000")


class Base(DeclarativeBase):
    metadata = MetaData()


class BareOrder(Base):
    __tablename__ = "orders"

    id: Mapped[str] = mapped_column(String(36), primary_key=True)
    from_post: Mapped[str]
    to_post: Mapped[str]
    recipient: Mapped[str]
    description: Mapped[str | None]
    created_at: Mapped[datetime] = mapped_column(DateTime())


class OrderRequest(BaseModel):
    from_post: str
    to_post: str
    recipient: str
    description: str | None = None


class Placed(BaseModel):
    id: str


def create(database: str) -> FastAPI:
    engine = create_async_engine(f"sqlite+aiosqlite:///{database}")

    @event.listens_for(engine.sync_engine, "connect")
    def prepare(connection: Any, record: Any) -> None:
        cursor = connection.cursor()
        for pragma in PRAGMAS:
            cursor.execute(f"PRAGMA {pragma}")
        cursor.close()

    @asynccontextmanager
    async def lifespan(_: FastAPI) -> AsyncIterator[None]:
        async with engine.begin() as connection:
            await connection.run_sync(Base.metadata.create_all)
        yield
        await engine.dispose()

    app = FastAPI(lifespan=lifespan)

    @app.post("/api/v1/orders", status_code=201)
    async def place(request: OrderRequest) -> Placed:
        order_id = str(uuid4())
        async with AsyncSession(engine) as session:
            session.add(
                BareOrder(id=order_id, created_at=datetime.now(UTC).replace(tzinfo=None), **request.model_dump())
            )
            await session.commit()
        return Placed(id=order_id)

    @app.get("/healthz")
    async def healthy() -> dict[str, bool]:
        return {"ok": True}

    return app


if __name__ == "__main__":
    uvicorn.run(create(sys.argv[1]), host="127.0.0.1", port=int(sys.argv[2]), log_config=None, access_log=False)
