# The service as an image: `docker build -t campus-mail .`. compose.yaml runs it with PostgreSQL and a proxy.
# Both stages need the same base, since the environment of the first runs in the second.
ARG BASE=python:3.13-slim-trixie

FROM ${BASE} AS build
WORKDIR /source
COPY . .
# pip builds the wheel and installs it; the build fetches what the pages use by itself (.ci/wheel.py).
RUN python -m venv /opt/campus-mail \
 && /opt/campus-mail/bin/pip install --no-cache-dir --constraint constraints.txt ".[service,postgres]"

FROM ${BASE}
# pg_dump and pg_restore, for `campus-mail backup`: not older than the database in compose.yaml.
# hadolint ignore=DL3008
RUN apt-get update \
 && apt-get install --yes --no-install-recommends postgresql-client \
 && rm -rf /var/lib/apt/lists/* \
 && useradd --uid 10001 --no-log-init campus-mail \
 && install --directory --mode 700 --owner campus-mail /var/lib/campus-mail
COPY --from=build /opt/campus-mail /opt/campus-mail
ENV PATH=/opt/campus-mail/bin:$PATH PYTHONUNBUFFERED=1 CAMPUS_MAIL_DATA=/var/lib/campus-mail CAMPUS_MAIL_PORT=8000
USER 10001
WORKDIR /var/lib/campus-mail
VOLUME /var/lib/campus-mail
HEALTHCHECK --start-period=60s --interval=15s --timeout=5s \
  CMD ["python", "-c", "import os, urllib.request as http; \
       http.urlopen(f'http://127.0.0.1:{os.environ[\"CAMPUS_MAIL_PORT\"]}/healthz', timeout=4)"]
CMD ["campus-mail", "serve"]
